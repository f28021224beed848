//! What one node is asked over SDO, an object after the other, and what it says.

use fieldproof_wire::canopen::sdo::{Request, Response, Transfer};
use fieldproof_wire::canopen::{AbortCode, Multiplexer};

/// What is asked, in this order.
const OBJECTS: [Multiplexer; 6] = [
    Multiplexer::new(0x1000, 0),
    Multiplexer::new(0x1018, 1),
    Multiplexer::new(0x1018, 2),
    Multiplexer::new(0x1018, 3),
    Multiplexer::new(0x1018, 4),
    DEVICE_NAME,
];

const DEVICE_NAME: Multiplexer = Multiplexer::new(0x1008, 0);

/// Nobody's name is longer, in bytes; what goes on is broken off.
const LONGEST: usize = 256;

/// What a node says of itself. What it has not, or does not say, is `None`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Answers {
    /// 1000h.
    pub device_type: Option<u32>,
    /// 1018h:01 to 04: vendor, product, revision, serial number.
    pub identity: [Option<u32>; 4],
    /// 1008h.
    pub name: Option<String>,
}

/// A conversation with one node. It is told what comes and says what is to be sent; it knows no time.
#[derive(Debug, Default)]
pub(super) struct Questions {
    /// Which of the [`OBJECTS`] is asked for.
    asked: usize,
    segments: Option<Segments>,
    answers: Answers,
    has_answered: bool,
}

/// A value that comes in segments.
#[derive(Debug, Default)]
struct Segments {
    toggle: bool,
    bytes: Vec<u8>,
}

impl Questions {
    /// What is to be sent first.
    pub(super) fn first() -> Request {
        Request::InitiateUpload(OBJECTS[0])
    }

    /// Whether all is said.
    pub(super) fn is_over(&self) -> bool {
        self.asked >= OBJECTS.len()
    }

    /// What the node has said, if it has said anything.
    pub(super) fn into_answers(self) -> Option<Answers> {
        self.has_answered.then_some(self.answers)
    }

    /// The node's SDO server sent `data`. Gives what is to be sent now; nothing if it was no answer to what was asked.
    pub(super) fn hear(&mut self, data: &[u8]) -> Vec<Request> {
        let (Some(object), Ok(response)) =
            (OBJECTS.get(self.asked).copied(), Response::parse(data))
        else {
            return Vec::new();
        };
        match (response, self.segments.take()) {
            (Response::Abort { object: of, .. }, _) if of == object => self.next(None),
            (
                Response::InitiateUpload {
                    object: of,
                    transfer,
                },
                None,
            ) if of == object => match transfer {
                Transfer::Expedited(value) => self.next(Some(value.bytes())),
                Transfer::ExpeditedUnsized(value) => self.next(Some(&value)),
                Transfer::Segmented { .. } => {
                    self.has_answered = true;
                    self.segments = Some(Segments::default());
                    vec![Request::UploadSegment { toggle: false }]
                }
            },
            (Response::UploadSegment(segment), Some(mut segments)) => {
                segments.bytes.extend(segment.data.bytes());
                let is_wrong = segment.toggle != segments.toggle;
                if is_wrong || segments.bytes.len() > LONGEST {
                    return self.break_off(object);
                }
                if segment.last {
                    return self.next(Some(&segments.bytes));
                }
                segments.toggle = !segments.toggle;
                let toggle = segments.toggle;
                self.segments = Some(segments);
                vec![Request::UploadSegment { toggle }]
            }
            (_, segments) => {
                self.segments = segments;
                Vec::new()
            }
        }
    }

    /// The node has not answered in time. Gives what is to be sent so that it waits for nothing.
    pub(super) fn give_up(&mut self) -> Option<Request> {
        let object = *OBJECTS.get(self.asked)?;
        self.asked = OBJECTS.len();
        self.segments.take()?;
        let code = AbortCode::TIMED_OUT;
        Some(Request::Abort { object, code })
    }

    fn break_off(&mut self, object: Multiplexer) -> Vec<Request> {
        let code = AbortCode::GENERAL_ERROR;
        let mut requests = vec![Request::Abort { object, code }];
        requests.extend(self.next(None));
        requests
    }

    /// Keeps the value of the object that was asked for, and asks for the next.
    fn next(&mut self, value: Option<&[u8]>) -> Vec<Request> {
        self.has_answered = true;
        if let (Some(object), Some(value)) = (OBJECTS.get(self.asked), value) {
            self.keep(*object, value);
        }
        self.asked += 1;
        let next = OBJECTS.get(self.asked);
        next.map(|object| Request::InitiateUpload(*object))
            .into_iter()
            .collect()
    }

    fn keep(&mut self, object: Multiplexer, value: &[u8]) {
        if object == DEVICE_NAME {
            let text = String::from_utf8_lossy(value);
            let text = text.trim_end_matches('\0').trim();
            self.answers.name = (!text.is_empty()).then(|| text.to_owned());
            return;
        }
        // A number that is shorter than it should be is still one.
        let number = value
            .iter()
            .rev()
            .fold(0u32, |number, byte| number << 8 | u32::from(*byte));
        let place = match object.sub {
            0 => &mut self.answers.device_type,
            sub => match self.answers.identity.get_mut(usize::from(sub) - 1) {
                Some(place) => place,
                None => return,
            },
        };
        *place = Some(number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is sent, as bytes, after each of these answers.
    fn talk(questions: &mut Questions, answers: &[&str]) -> Vec<Vec<String>> {
        let bytes = |text: &str| -> Vec<u8> {
            let digits = text.as_bytes().chunks(2);
            let digits = digits.map(|pair| std::str::from_utf8(pair).expect("digits"));
            digits
                .map(|pair| u8::from_str_radix(pair, 16).expect("digits"))
                .collect()
        };
        let shown = |request: &Request| -> String {
            request
                .encode()
                .iter()
                .map(|byte| format!("{byte:02X}"))
                .collect()
        };
        answers
            .iter()
            .map(|answer| questions.hear(&bytes(answer)).iter().map(shown).collect())
            .collect()
    }

    #[test]
    fn objects_are_asked_for_one_after_the_other() {
        let mut questions = Questions::default();
        assert_eq!(Questions::first().encode()[..4], [0x40, 0x00, 0x10, 0x00]);
        let sent = talk(
            &mut questions,
            &[
                "4300100092010200",
                "430118103C060000", // of another object: not what was asked for
                "431810013C060000",
                "4F18100201000000",
                "8018100300000906",
                "4318100478563412",
                "4108100003000000",
                "094C4D4100000000",
            ],
        );
        let expected: [&[&str]; 8] = [
            &["4018100100000000"],
            &[],
            &["4018100200000000"],
            &["4018100300000000"],
            &["4018100400000000"],
            &["4008100000000000"],
            &["6000000000000000"],
            &[],
        ];
        assert_eq!(sent, expected);
        assert!(questions.is_over());
        let answers = Answers {
            device_type: Some(0x0002_0192),
            identity: [Some(0x63C), Some(1), None, Some(0x1234_5678)],
            name: Some("LMA".to_owned()),
        };
        assert_eq!(questions.into_answers(), Some(answers));
    }

    #[test]
    fn segment_with_the_wrong_toggle_is_broken_off() {
        let mut questions = Questions::default();
        let sent = talk(&mut questions, &["4100100008000000", "1061626364656667"]);
        assert_eq!(sent[1], ["8000100000000008", "4018100100000000"]);
    }

    #[test]
    fn value_without_an_end_is_broken_off() {
        let mut questions = Questions::default();
        questions.hear(&[0x40, 0x00, 0x10, 0, 0, 0, 0, 0]);
        let segments = (0..).map(|count: u8| (count & 1) << 4);
        let answered = segments
            .take(40)
            .map(|command| questions.hear(&[command, 1, 2, 3, 4, 5, 6, 7]))
            .find(|sent| sent.len() != 1);
        assert!(matches!(
            answered.as_deref(),
            Some([Request::Abort { .. }, Request::InitiateUpload(_)])
        ));
    }

    #[test]
    fn node_that_falls_silent_is_not_left_waiting() {
        let mut silent = Questions::default();
        assert_eq!(silent.give_up(), None);
        assert!(silent.is_over());
        assert_eq!(silent.into_answers(), None);

        let mut halfway = Questions::default();
        halfway.hear(&[0x40, 0x00, 0x10, 0, 0, 0, 0, 0]);
        assert!(matches!(halfway.give_up(), Some(Request::Abort { .. })));
        assert_eq!(halfway.into_answers(), Some(Answers::default()));
    }

    #[test]
    fn what_is_no_answer_is_passed_over() {
        let mut questions = Questions::default();
        let noise: [&[u8]; 4] = [&[], &[0xFF; 8], &[0; 8], &[0x60, 0x00, 0x10, 0, 0, 0, 0, 0]];
        for data in noise {
            assert_eq!(questions.hear(data), []);
        }
        assert_eq!(questions.into_answers(), None);
    }
}
