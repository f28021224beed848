//! Heartbeat consumers: other nodes that must be heard.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::emergency::DeviceError;
use super::objects::Objects;
use super::{Abort, Address, Behaviour, Slave};

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
    pub(super) fn read(objects: &Objects, behaviour: &Behaviour, now: Instant) -> Consumers {
        let settings = &behaviour.error_control;
        let entries = (1..=127).map_while(|sub| objects.number(Address::new(CONSUMER_TIME, sub)));
        let used = entries.take(settings.consumer_entries).filter_map(consumer);
        let set = used.map(|consumer| {
            let time = consumer.time * settings.consumer_percent / 100;
            let until = (!settings.consumer_waits_for_first).then(|| now + time);
            Consumer {
                time,
                until,
                ..consumer
            }
        });
        Consumers(set.collect())
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
pub(super) fn check(
    objects: &Objects,
    behaviour: &Behaviour,
    address: Address,
    entry: u32,
) -> Result<(), Abort> {
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
    let taken = others.any(|other| other.node == asked.node);
    if taken && behaviour.error_control.consumer_entry_once {
        return Err(Abort::INCOMPATIBLE);
    }
    Ok(())
}

impl Slave {
    fn heartbeat_lost(&self) -> DeviceError {
        DeviceError {
            code: self.behaviour.error_control.lost_heartbeat_code,
            register_bit: 0x10,
        }
    }

    /// 1016h was written: what was listened to before is forgotten.
    pub(super) fn reconfigure_consumers(&mut self, now: Instant) {
        let fresh = Consumers::read(&self.objects, &self.behaviour, now);
        let before = std::mem::replace(&mut self.consumers, fresh);
        let found_again = before.0.iter().filter(|consumer| consumer.lost).count();
        if !self.behaviour.error_control.consumer_can_be_stopped {
            let set = self.consumers.0.iter().map(|consumer| consumer.node);
            let set: Vec<u8> = set.collect();
            let stopped = before.0.into_iter();
            let stopped = stopped.filter(|consumer| !set.contains(&consumer.node));
            self.consumers.0.extend(stopped);
        }
        for _ in 0..found_again {
            self.set_error(now, self.heartbeat_lost(), false);
        }
    }

    /// Another node's error control. Its boot-up is no heartbeat: it is waited for again.
    pub(super) fn hear(&mut self, now: Instant, node: u16, frame: &Frame) {
        let &[state] = frame.bytes() else { return };
        let settings = &self.behaviour.error_control;
        if state != 0x05 && !settings.consumer_takes_any_state {
            return;
        }
        let mut found_again = 0;
        for consumer in &mut self.consumers.0 {
            let meant = u16::from(consumer.node) == node || !settings.consumer_compares_node;
            if !meant || (consumer.lost && !settings.consumer_resumes) {
                continue;
            }
            consumer.until = (state != 0).then(|| now + consumer.time);
            if state != 0 && std::mem::take(&mut consumer.lost) {
                found_again += 1;
            }
        }
        for _ in 0..found_again {
            self.set_error(now, self.heartbeat_lost(), false);
        }
    }

    pub(super) fn wake_consumers(&mut self, now: Instant) {
        let once = self.behaviour.error_control.lost_heartbeat_reported_once;
        let (mut lost, mut lost_again) = (0, 0);
        for consumer in &mut self.consumers.0 {
            if consumer.until.is_some_and(|until| until <= now) {
                consumer.until = (!once).then(|| now + consumer.time);
                if std::mem::replace(&mut consumer.lost, true) {
                    lost_again += 1;
                } else {
                    lost += 1;
                }
            }
        }
        if !self.behaviour.lost_heartbeat_noticed {
            return;
        }
        for _ in 0..lost {
            self.set_error(now, self.heartbeat_lost(), true);
            self.communication_failed();
        }
        for _ in 0..lost_again {
            self.report(now, self.heartbeat_lost());
        }
    }
}
