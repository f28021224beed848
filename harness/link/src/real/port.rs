//! What every kind of real link is to the lane.

use std::os::fd::BorrowedFd;
use std::time::Duration;

use super::{Clock, OpenError};
use crate::{Farewell, Instant, Line, LinkError, PortProperties, Reception, Sent, Transmission};

/// A port on a real link. It never waits: the lane waits for all its ports at once.
pub trait Port: Send {
    /// What a caller may know of it. The role is what the opener was told.
    fn properties(&self) -> &PortProperties;

    /// Readable once something has arrived.
    fn readable(&self) -> BorrowedFd<'_>;

    /// Gives `what` to the system to send.
    ///
    /// # Errors
    /// [`SendError::Busy`] if the system takes no more for the moment; [`LinkError`] if the link cannot carry it or is
    /// gone.
    fn send(&mut self, clock: &mut Clock, what: &Transmission) -> Result<Departure, SendError>;

    /// Moves everything that has arrived by now into `news`, oldest first.
    ///
    /// # Errors
    /// [`LinkError`]: the link is gone, or something was lost.
    fn take(&mut self, clock: &mut Clock, news: &mut Vec<News>) -> Result<(), LinkError>;

    /// Like [`Port::take`], but waits up to [`SHORT_WAIT`] for more than what has not [left](News::Left) yet. `None` if
    /// the port cannot do that in one system call, which is all that this is for.
    ///
    /// # Errors
    /// [`LinkError`]: the link is gone, or something was lost.
    fn take_waiting(
        &mut self,
        clock: &mut Clock,
        news: &mut Vec<News>,
    ) -> Option<Result<(), LinkError>> {
        let _ = (clock, news);
        None
    }

    /// How long a frame may wait for its turn and its acknowledge, and the port be busy.
    fn patience(&self) -> Duration {
        PATIENCE
    }

    /// Opens a further connection to where this one leads; `None` if it is none.
    ///
    /// # Errors
    /// [`OpenError`]: it is not taken.
    fn again(&self, name: &str) -> Option<Result<Box<dyn Port>, OpenError>> {
        let _ = name;
        None
    }

    /// What is to be done before it is dropped, so that it ends so.
    fn farewell(&mut self, how: Farewell) {
        let _ = how;
    }

    /// Sets it otherwise: another bit rate, say.
    ///
    /// # Errors
    /// [`LinkError`]: it cannot be set so.
    fn set_line(&mut self, line: Line) -> Result<(), LinkError>;
}

/// The [`Port::patience`] of a port that knows no better.
const PATIENCE: Duration = Duration::from_millis(100);

/// The longest that [`Port::take_waiting`] waits: 10 ms as asked for, and as many again as a slow kernel clock may add
/// twice.
pub const SHORT_WAIT: Duration = Duration::from_millis(30);

/// When what was given to a port leaves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Departure {
    /// Then; nothing more will be heard of it.
    At(Sent),
    /// It will be told by [`News::Left`].
    Told,
}

/// Something a port has to tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum News {
    /// Something arrived; `at` is the end of its last bit.
    Arrived {
        /// When.
        at: Instant,
        /// What.
        what: Reception,
    },
    /// The oldest transmission that has not left yet was on the wire.
    Left(Sent),
}

/// Why a port did not take something to send.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SendError {
    /// Its queue is full; try again.
    Busy,
    /// It cannot.
    Link(LinkError),
}

impl From<LinkError> for SendError {
    fn from(error: LinkError) -> SendError {
        SendError::Link(error)
    }
}

/// `port` is gone, or cannot do what is asked of it, in the words of the system.
pub(super) fn down(port: &PortProperties, reason: impl ToString) -> LinkError {
    LinkError::Down {
        port: port.name.clone(),
        reason: reason.to_string(),
    }
}
