//! What frames that mean nothing do to a slave that was not built for them.

use std::time::Duration;

use fieldproof_can::{Frame, Id, StandardId};
use fieldproof_link::Instant;

use super::emergency::PDO_TOO_SHORT;
use super::error_control::ErrorControl;
use super::queue::identifier;
use super::{Application, Slave};

/// Two frames that follow each other within this time belong to one burst.
const BURST_GAP: Duration = Duration::from_millis(1);
/// How many frames of a burst a small receive buffer holds.
const RECEIVE_BUFFER: u32 = 64;
/// How many frames for nobody a leak survives.
const LEAK: u32 = 127;

/// How a slave bears what it does not understand. The default bears everything.
#[derive(Debug, Clone, Copy, Default)]
pub struct Robustness {
    /// It takes nothing more after an SDO request whose command specifier there is none of.
    pub stops_at_unknown_command: bool,
    /// It takes nothing more after a remote frame on the identifier of its SDO requests.
    pub stops_at_remote_request: bool,
    /// It takes nothing more after an SDO request without data.
    pub stops_at_empty_request: bool,
    /// It takes nothing more after a burst that is longer than its receive buffer.
    pub stops_at_burst: bool,
    /// It takes nothing more after so many frames that were for nobody.
    pub leaks: bool,
    /// The identifier of an extended frame is cut to 11 bits.
    pub extended_taken_as_standard: bool,
    /// An NMT command without a node-ID is one to all.
    pub nmt_without_node_obeyed: bool,
    /// A remote frame with the identifier of NMT stops the node.
    pub stops_at_remote_nmt: bool,
    /// A SYNC of more than a byte resets it.
    pub long_sync_resets: bool,
    /// A TIME of fewer than six bytes resets it.
    pub short_time_resets: bool,
    /// A heartbeat of another node that is not one byte ends its own.
    pub foreign_heartbeat_ends_own: bool,
    /// A frame that is for nobody is reported as an error.
    pub unknown_identifier_reported: bool,
    /// Of the node-ID in the identifier of an SDO request six bits count.
    pub sdo_filter_of_six_bits: bool,
    /// The node-ID with which it takes no SDO requests.
    pub no_sdo_at: Option<u8>,
    /// An RPDO without data resets it.
    pub empty_pdo_resets: bool,
}

/// What has become of it.
#[derive(Debug, Default)]
pub(super) struct Strain {
    stopped: bool,
    last_frame: Option<Instant>,
    burst: u32,
    for_nobody: u32,
}

impl Slave {
    /// The frame that the slave makes of one that came; `None` if it takes none.
    pub(super) fn bear(
        &mut self,
        now: Instant,
        frame: &Frame,
        application: &mut dyn Application,
    ) -> Option<Frame> {
        let bearing = self.behaviour.robustness;
        self.count_burst(now);
        let frame = match frame.id() {
            Id::Standard(_) => *frame,
            Id::Extended(id) if bearing.extended_taken_as_standard => {
                let low = u16::try_from(id.raw() & 0x7FF).ok()?;
                frame.with_id(StandardId::new(low)?)
            }
            Id::Extended(_) => return None,
        };
        let raw = frame.standard_id()?.raw();
        let node = u16::from(self.node);
        let (len, remote) = (frame.len(), frame.is_remote());
        let own_request = raw == 0x600 + node;
        let unknown = matches!(frame.bytes(), [0xE0..=0xFF, ..]);
        self.strain.stopped |= own_request
            && ((bearing.stops_at_remote_request && remote)
                || (bearing.stops_at_empty_request && !remote && len == 0)
                || (bearing.stops_at_unknown_command && unknown));
        if self.strain.stopped || own_request && bearing.no_sdo_at == Some(self.node) {
            return None;
        }
        if bearing.stops_at_remote_nmt && raw == 0 && remote {
            self.strain.stopped = true;
        }
        let resets = (bearing.long_sync_resets && raw == 0x080 && len > 1)
            || (bearing.short_time_resets && raw == 0x100 && !remote && len < 6)
            || (bearing.empty_pdo_resets && raw == 0x200 + node && !remote && len == 0);
        if resets {
            self.reset_node(now, super::slave::ALL, application);
            return None;
        }
        let heartbeat = (0x701..=0x77F).contains(&raw) && raw != 0x700 + node;
        if bearing.foreign_heartbeat_ends_own && heartbeat && !remote && len != 1 {
            self.error_control = ErrorControl::default();
        }
        self.count_for_nobody(now, raw);
        Some(self.taken_for_another(frame))
    }

    fn count_burst(&mut self, now: Instant) {
        let strain = &mut self.strain;
        let follows = strain
            .last_frame
            .is_some_and(|last| now.since(last) <= BURST_GAP);
        strain.burst = if follows { strain.burst + 1 } else { 1 };
        strain.last_frame = Some(now);
        if strain.burst > RECEIVE_BUFFER && self.behaviour.robustness.stops_at_burst {
            strain.stopped = true;
        }
    }

    /// Identifiers that CiA 301 gives to nothing.
    fn count_for_nobody(&mut self, now: Instant, raw: u16) {
        if !matches!(raw, 0x001..=0x07F | 0x680..=0x6DF | 0x780..=0x7DF) {
            return;
        }
        self.strain.for_nobody += 1;
        if self.behaviour.robustness.leaks && self.strain.for_nobody > LEAK {
            self.strain.stopped = true;
        }
        if self.behaviour.robustness.unknown_identifier_reported {
            self.report(now, PDO_TOO_SHORT);
        }
    }

    fn taken_for_another(&self, frame: Frame) -> Frame {
        let bearing = &self.behaviour.robustness;
        let raw = frame.standard_id().map_or(0, StandardId::raw);
        let node = u16::from(self.node);
        let same_low_bits = (0x601..=0x67F).contains(&raw) && (raw ^ node) & 0x3F == 0;
        if bearing.sdo_filter_of_six_bits && same_low_bits && !frame.is_remote() {
            return frame.with_id(identifier(0x600 + node));
        }
        if bearing.nmt_without_node_obeyed
            && raw == 0
            && let [command] = frame.bytes()
        {
            return Frame::data(frame.id(), &[*command, 0]).unwrap_or(frame);
        }
        frame
    }
}
