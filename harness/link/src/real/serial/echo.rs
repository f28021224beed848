//! An RS-485 transceiver that gives back what it sends.

use std::collections::VecDeque;
use std::fmt;
use std::time::Duration;

use crate::{Character, Instant};

/// Whether a port hears itself.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum LocalEcho {
    /// The first transmission tells.
    #[default]
    Auto,
    /// What is sent comes back, and must.
    Yes,
    /// What is sent does not come back.
    No,
}

/// How long after its time an echo is missed: nobody may have looked.
const PATIENCE: Duration = Duration::from_millis(100);

/// A character and the instant at which it ended.
pub(super) type Dated = (Instant, Character);

/// Takes what comes back out of what comes.
#[derive(Debug)]
pub(super) struct Echo {
    setting: LocalEcho,
    /// What was sent and has not come back yet.
    expected: VecDeque<u8>,
    /// By when it comes back, if it does.
    back_by: Instant,
    /// While it is not known whether there is an echo: what came back so far, which may be no echo at all.
    held: Vec<Dated>,
    /// What came and is no echo, oldest first; the port takes it from here.
    pub(super) heard: Vec<Dated>,
}

/// Something else came back than was sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NoEcho {
    sent: u8,
    came: Option<u8>,
}

impl fmt::Display for NoEcho {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sent = self.sent;
        match self.came {
            Some(came) => write!(f, "it sent {sent:02X} and heard {came:02X} in its place")?,
            None => write!(f, "it sent {sent:02X} and did not hear it")?,
        }
        f.write_str(": two sent at once, or the port has no local echo, which `echo=no` says")
    }
}

impl Echo {
    pub(super) fn new(setting: LocalEcho) -> Echo {
        Echo {
            setting,
            expected: VecDeque::new(),
            back_by: Instant::START,
            held: Vec::new(),
            heard: Vec::new(),
        }
    }

    /// `bytes` are being sent; if they come back, then by `back_by`. What is an answer comes later.
    pub(super) fn sent(&mut self, bytes: impl Iterator<Item = u8>, back_by: Instant) {
        if self.setting != LocalEcho::No {
            self.expected.extend(bytes);
            self.back_by = back_by;
        }
    }

    /// A character came that was read at `read`.
    pub(super) fn came(&mut self, read: Instant, dated: Dated) -> Result<(), NoEcho> {
        self.give_up_learning(read);
        let came = dated.1.byte;
        match (self.setting, self.expected.front()) {
            (LocalEcho::No, _) | (_, None) => self.heard.push(dated),
            (LocalEcho::Yes, Some(&sent)) if came == sent => {
                self.expected.pop_front();
            }
            (LocalEcho::Yes, Some(&sent)) => {
                let came = Some(came);
                return Err(NoEcho { sent, came });
            }
            (LocalEcho::Auto, Some(&sent)) => {
                self.held.push(dated);
                if came == sent {
                    self.expected.pop_front();
                } else {
                    self.setting = LocalEcho::No;
                    self.release();
                }
                if self.setting == LocalEcho::Auto && self.expected.is_empty() {
                    self.setting = LocalEcho::Yes;
                    self.held.clear();
                }
            }
        }
        Ok(())
    }

    /// It is `now`, and everything is read that has come.
    pub(super) fn pass(&mut self, now: Instant) -> Result<(), NoEcho> {
        self.give_up_learning(now);
        match (self.setting, self.expected.front()) {
            (LocalEcho::Yes, Some(&sent)) if now > self.back_by + PATIENCE => {
                Err(NoEcho { sent, came: None })
            }
            _ => Ok(()),
        }
    }

    /// Whatever comes too late may be an echo that was read late, or an answer that is the same as the request: it
    /// teaches nothing, and the next transmission may.
    fn give_up_learning(&mut self, now: Instant) {
        if self.setting == LocalEcho::Auto && now > self.back_by {
            self.release();
        }
    }

    fn release(&mut self) {
        self.expected.clear();
        self.heard.append(&mut self.held);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const REQUEST: [u8; 3] = [0x01, 0x03, 0x10];

    fn ms(milliseconds: u64) -> Instant {
        Instant::from_nanos(milliseconds * 1_000_000)
    }

    /// Has sent the request, which comes back by 12 ms if it does.
    fn echo(setting: LocalEcho) -> Echo {
        let mut echo = Echo::new(setting);
        echo.sent(REQUEST.into_iter(), ms(12));
        echo
    }

    /// What is heard once these bytes are read at `read`.
    fn hear(echo: &mut Echo, read: Instant, bytes: &[u8]) -> Result<Vec<u8>, NoEcho> {
        for &byte in bytes {
            echo.came(read, (read, Character::new(byte)))?;
        }
        echo.pass(read)?;
        Ok(echo.heard.drain(..).map(|(_, it)| it.byte).collect())
    }

    #[test]
    fn an_echo_is_dropped_and_the_answer_heard() {
        let mut echo = echo(LocalEcho::Yes);
        assert_eq!(hear(&mut echo, ms(10), &[0x01, 0x03]), Ok(vec![]));
        assert_eq!(
            hear(&mut echo, ms(15), &[0x10, 0x01, 0x03]),
            Ok(vec![0x01, 0x03])
        );
    }

    #[test]
    fn something_else_in_the_place_of_an_echo_is_an_error() {
        let mut echo = echo(LocalEcho::Yes);
        let error = hear(&mut echo, ms(10), &[0x01, 0x43]).unwrap_err();
        let told = error.to_string();
        assert!(
            told.starts_with("it sent 03 and heard 43 in its place"),
            "{told}"
        );
    }

    #[test]
    fn an_echo_that_never_comes_is_an_error() {
        let mut echo = echo(LocalEcho::Yes);
        assert_eq!(hear(&mut echo, ms(112), &[]), Ok(vec![]));
        let told = hear(&mut echo, ms(113), &[]).unwrap_err().to_string();
        assert!(told.starts_with("it sent 01 and did not hear it"), "{told}");
    }

    #[test]
    fn an_echo_that_nobody_looked_for_in_time_is_one() {
        let mut echo = echo(LocalEcho::Yes);
        assert_eq!(hear(&mut echo, ms(500), &REQUEST), Ok(vec![]));
    }

    #[test]
    fn no_echo_is_expected_where_there_is_none() {
        let mut echo = echo(LocalEcho::No);
        assert_eq!(hear(&mut echo, ms(10), &REQUEST), Ok(REQUEST.to_vec()));
        assert_eq!(hear(&mut echo, ms(1_000), &[]), Ok(vec![]));
    }

    #[test]
    fn the_first_transmission_tells_of_an_echo() {
        let mut echo = echo(LocalEcho::Auto);
        assert_eq!(hear(&mut echo, ms(9), &[0x01]), Ok(vec![]));
        assert_eq!(hear(&mut echo, ms(12), &[0x03, 0x10, 0x01]), Ok(vec![0x01]));
        echo.sent([0x55].into_iter(), ms(20));
        assert!(hear(&mut echo, ms(20), &[0x56]).is_err());
    }

    #[test]
    fn an_answer_that_begins_like_the_request_tells_that_there_is_none() {
        let mut echo = echo(LocalEcho::Auto);
        assert_eq!(hear(&mut echo, ms(12), &[0x01, 0x03]), Ok(vec![]));
        assert_eq!(hear(&mut echo, ms(12), &[0x02]), Ok(vec![0x01, 0x03, 0x02]));
        echo.sent([0x55].into_iter(), ms(20));
        assert_eq!(hear(&mut echo, ms(20), &[0x55]), Ok(vec![0x55]));
    }

    #[test]
    fn what_comes_too_late_is_an_answer_and_teaches_nothing() {
        let mut echo = echo(LocalEcho::Auto);
        assert_eq!(hear(&mut echo, ms(13), &REQUEST), Ok(REQUEST.to_vec()));
        echo.sent(REQUEST.into_iter(), ms(22));
        assert_eq!(hear(&mut echo, ms(22), &REQUEST), Ok(vec![]));
    }

    #[test]
    fn a_beginning_that_is_not_continued_is_heard_in_the_end_as_it_was_dated() {
        let mut echo = echo(LocalEcho::Auto);
        assert_eq!(hear(&mut echo, ms(11), &[0x01]), Ok(vec![]));
        assert_eq!(echo.pass(ms(12)), Ok(()));
        assert_eq!(echo.heard, []);
        assert_eq!(echo.pass(ms(13)), Ok(()));
        assert_eq!(echo.heard, [(ms(11), Character::new(0x01))]);
    }
}
