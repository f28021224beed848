//! Heartbeat consumers: other nodes that must be heard.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::emergency::HEARTBEAT_LOST;
use super::objects::Objects;
use super::{Abort, Address, Slave};

/// The consumer heartbeat time, an array.
pub(super) const CONSUMER_TIME: u16 = 0x1016;

/// One node that is listened to.
#[derive(Debug, Clone, Copy)]
struct Consumer {
    node: u8,
    time: Duration,
    /// When it is lost, once its first heartbeat has come.
    until: Option<Instant>,
    lost: bool,
}

/// The nodes that are listened to.
#[derive(Debug, Default)]
pub(super) struct Consumers(Vec<Consumer>);

impl Consumers {
    /// | bits of an entry | hold |
    /// | --- | --- |
    /// | 23 to 16 | node-ID; 0 and above 127: not used |
    /// | 15 to 0 | time in ms; 0: not used |
    pub(super) fn read(objects: &Objects) -> Consumers {
        let entries = (1..=127).map_while(|sub| objects.number(Address::new(CONSUMER_TIME, sub)));
        Consumers(entries.filter_map(consumer).collect())
    }

    pub(super) fn due(&self) -> Option<Instant> {
        self.0.iter().filter_map(|consumer| consumer.until).min()
    }
}

fn consumer(entry: u32) -> Option<Consumer> {
    let [low, high, node, _] = entry.to_le_bytes();
    let time = u16::from_le_bytes([low, high]);
    (time != 0 && (1..=127).contains(&node)).then(|| Consumer {
        node,
        time: Duration::from_millis(u64::from(time)),
        until: None,
        lost: false,
    })
}

/// Whether `entry` may be written to `address` of 1016h.
///
/// # Errors
/// Reserved bits are set, or another entry listens to the same node.
pub(super) fn check(objects: &Objects, address: Address, entry: u32) -> Result<(), Abort> {
    if entry >> 24 != 0 {
        return Err(Abort::INVALID_VALUE);
    }
    let Some(asked) = consumer(entry) else {
        return Ok(());
    };
    let others = (1..=127).filter(|sub| *sub != address.sub());
    let mut others = others.filter_map(|sub| {
        let entry = objects.number(Address::new(CONSUMER_TIME, sub))?;
        consumer(entry)
    });
    if others.any(|other| other.node == asked.node) {
        return Err(Abort::INCOMPATIBLE);
    }
    Ok(())
}

impl Slave {
    /// 1016h was written: what was listened to before is forgotten.
    pub(super) fn reconfigure_consumers(&mut self, now: Instant) {
        let before = std::mem::replace(&mut self.consumers, Consumers::read(&self.objects));
        for _ in before.0.iter().filter(|consumer| consumer.lost) {
            self.set_error(now, HEARTBEAT_LOST, false);
        }
    }

    /// Another node's error control. Its boot-up is no heartbeat: it is waited for again.
    pub(super) fn hear(&mut self, now: Instant, node: u16, frame: &Frame) {
        let &[state] = frame.bytes() else { return };
        let mut found_again = 0;
        for consumer in &mut self.consumers.0 {
            if u16::from(consumer.node) != node {
                continue;
            }
            consumer.until = (state != 0).then(|| now + consumer.time);
            if state != 0 && std::mem::take(&mut consumer.lost) {
                found_again += 1;
            }
        }
        for _ in 0..found_again {
            self.set_error(now, HEARTBEAT_LOST, false);
        }
    }

    pub(super) fn wake_consumers(&mut self, now: Instant) {
        let mut lost = 0;
        for consumer in &mut self.consumers.0 {
            if consumer.until.is_some_and(|until| until <= now) {
                consumer.until = None;
                consumer.lost = true;
                lost += 1;
            }
        }
        if !self.behaviour.lost_heartbeat_noticed {
            return;
        }
        for _ in 0..lost {
            self.set_error(now, HEARTBEAT_LOST, true);
            self.communication_failed();
        }
    }
}
