//! Writing an object, by SDO or by PDO: what is allowed, and what else it changes.

use fieldproof_link::Instant;

use super::emergency::ERROR_HISTORY;
use super::error_control::{GUARD_TIME, LIFE_TIME_FACTOR, PRODUCER_TIME};
use super::pdo;
use super::pdo_rules::{self, Parameter, Rules};
use super::services::ADDITIONAL_SERVERS;
use super::sync;
use super::{Abort, Address, Answer, Application, Slave};
use super::{cob_id, consumers, emergency, memory, time};

/// Software position limits of CiA 402: the lowest position at sub-index 1, the highest at 2.
const POSITION_LIMITS: u16 = 0x607D;

impl Slave {
    /// Writes `value` to the object at `slot`, for an SDO or a PDO; `false` if the application will say when it is done.
    pub(super) fn write(
        &mut self,
        now: Instant,
        address: Address,
        slot: usize,
        value: &[u8],
        application: &mut dyn Application,
    ) -> Result<bool, Abort> {
        let object = self.objects.at(slot).ok_or(Abort::NO_OBJECT)?;
        if !object.writable {
            return Err(Abort::READ_ONLY);
        }
        let limits_checked = self.behaviour.limits_checked && !self.count_unchecked(address, value);
        self.takes(address, object.takes(value, limits_checked), value)?;
        if let Some(twin) = self.twin(address).and_then(|twin| self.objects.get(twin)) {
            twin.takes(value, limits_checked)?;
        }
        match self.permitted(address, value) {
            Ok(true) => {}
            Ok(false) => return Ok(true),
            Err(abort) => {
                self.spoil_refused(address);
                return Err(abort);
            }
        }
        match application.writing(address, value) {
            Answer::Now => {}
            Answer::Refused(abort) => return Err(abort),
            Answer::Later => {
                self.objects.set(address, value);
                return Ok(false);
            }
        }
        for address in [Some(address), self.twin(address)].into_iter().flatten() {
            self.objects.set(address, value);
            application.written(address, &mut self.objects);
            self.keep(address);
            self.follow(now, address);
        }
        Ok(true)
    }

    /// What comes of a value that the object takes or refuses.
    fn takes(
        &mut self,
        address: Address,
        taken: Result<(), Abort>,
        value: &[u8],
    ) -> Result<(), Abort> {
        let settings = &self.behaviour.sdo;
        let checked = match taken {
            Err(Abort::TOO_HIGH) => settings.high_limit_checked,
            Err(Abort::TOO_LOW) => settings.low_limit_checked,
            other => return other,
        };
        if !checked {
            return Ok(());
        }
        if !settings.refused_not_written {
            self.objects.set(address, value);
        }
        taken
    }

    /// Whether this is a count of mapped objects that nothing is asked of, as in no right device.
    fn count_unchecked(&self, address: Address, value: &[u8]) -> bool {
        let mapping = Parameter::of(address.index()) == Some(Parameter::Mapping);
        let count = mapping && address.sub() == 0 && value.len() == 1;
        count && !self.behaviour.pdo.count_checked
    }

    /// What was refused is cleared by a device that has written before it checked.
    fn spoil_refused(&mut self, address: Address) {
        let entry =
            address.sub() != 0 && Parameter::of(address.index()) == Some(Parameter::Mapping);
        if entry && !self.behaviour.pdo.refused_entry_kept {
            self.objects.set_number(address, 0);
        }
    }

    fn twin(&self, address: Address) -> Option<Address> {
        let twins = self.profile.twins.iter();
        twins.fold(None, |found, (first, second)| match address {
            address if address == *first => Some(*second),
            address if address == *second => Some(*first),
            _ => found,
        })
    }

    /// Whether the value is to be stored as the others are; `false` if it was an order and is done.
    fn permitted(&mut self, address: Address, value: &[u8]) -> Result<bool, Abort> {
        let bytes = value.iter().take(4).rev();
        let number = bytes.fold(0, |number, byte| number << 8 | u32::from(*byte));
        let index = address.index();
        if let Some(parameter) = Parameter::of(index) {
            let rules = Rules {
                objects: &self.objects,
                profile: &self.profile,
                behaviour: &self.behaviour,
            };
            if !rules.check(parameter, address, value)? {
                return Ok(false);
            }
        } else if address == sync::COB_ID {
            let present = self.objects.number(address).unwrap_or(0);
            sync::check(&self.profile, &self.behaviour.departs, present, number)?;
        } else if index == consumers::CONSUMER_TIME && address.sub() != 0 {
            consumers::check(&self.objects, &self.behaviour, address, number)?;
        } else if index == POSITION_LIMITS {
            self.check_position_limits(address, number)?;
        } else if index == ERROR_HISTORY {
            if number == 0 {
                self.forget_errors();
            } else if !self.behaviour.departs.history_count_taken {
                return Err(Abort::INVALID_VALUE);
            }
            return Ok(false);
        } else if matches!(index, memory::STORE | memory::RESTORE) && address.sub() != 0 {
            self.store_or_restore(address, value)?;
            return Ok(false);
        } else if Some(address) == self.profile.node_object {
            if !(1..=127).contains(&number) {
                return Err(Abort::INVALID_VALUE);
            }
        } else if Some(address) == self.profile.bit_rate_object {
            let rates = self.profile.lss.map_or(&[][..], |lss| lss.bit_rates);
            if number as usize >= rates.len() {
                return Err(Abort::INVALID_VALUE);
            }
        }
        self.service_permitted(address, number)?;
        Ok(true)
    }

    /// The lowest position is not above the highest.
    fn check_position_limits(&self, address: Address, value: u32) -> Result<(), Abort> {
        let other = |sub| self.objects.number(Address::new(POSITION_LIMITS, sub));
        let (low, high) = match address.sub() {
            1 => (Some(value), other(2)),
            _ => (other(1), Some(value)),
        };
        match (low, high) {
            (Some(low), Some(high)) if low.cast_signed() > high.cast_signed() => {
                Err(Abort::MAXIMUM_BELOW_MINIMUM)
            }
            _ => Ok(()),
        }
    }

    /// The rules of services that not every slave has.
    fn service_permitted(&self, address: Address, value: u32) -> Result<(), Abort> {
        let number = |address| self.objects.number(address).unwrap_or(0);
        let valid = |cob_id| cob_id & pdo::INVALID == 0;
        let departs = &self.behaviour.departs;
        let written = (number(address), value);
        match (address.index(), address.sub()) {
            _ if address == sync::OVERFLOW => {
                sync::check_overflow(departs, number(sync::CYCLE), value)
            }
            _ if address == emergency::COB_ID => {
                let protected = !departs.emergency_identifier_unprotected;
                cob_id::check(written, valid, protected, departs)
            }
            _ if address == time::COB_ID => time::check(&self.profile, departs, written),
            (0x1201..=0x127F, 1 | 2) => cob_id::check(written, valid, true, departs),
            _ => Ok(()),
        }
    }

    /// Saves what is saved when it is written; a default need not be.
    fn keep(&mut self, address: Address) {
        if !self.profile.saved_on_write.contains(&address.index()) {
            return;
        }
        self.memory.values.remove(&address);
        if let Some(value) = self.objects.unless_default(address, self.node) {
            self.memory.values.insert(address, value.to_vec());
        }
    }

    /// What else a new value changes.
    fn follow(&mut self, now: Instant, address: Address) {
        let index = address.index();
        if Parameter::of(index).is_some() {
            if pdo_rules::is_transmit(index) {
                self.reconfigure_tpdo(now, index);
            } else {
                self.rpdos = pdo::rpdos(&self.objects, &self.behaviour);
            }
        } else if [sync::COB_ID, sync::CYCLE, sync::WINDOW, sync::OVERFLOW].contains(&address) {
            self.reconfigure_sync(now);
        } else if address == PRODUCER_TIME {
            self.reconfigure_heartbeat(now);
        } else if address == GUARD_TIME || address == LIFE_TIME_FACTOR {
            self.reconfigure_guarding(now);
        } else if Some(address) == self.profile.clock_object {
            self.set_clock(now);
        } else if address == time::COB_ID {
            self.reconfigure_time(now);
        } else if self.profile.consumes_heartbeats && index == consumers::CONSUMER_TIME {
            self.reconfigure_consumers(now);
        } else if self.profile.complete && ADDITIONAL_SERVERS.contains(&index) {
            self.reconfigure_server(index);
        } else if Some(address) == self.profile.node_object {
            let node = self.objects.number(address).unwrap_or(1);
            self.memory.node = node.to_le_bytes()[0];
            self.pending_node = self.memory.node;
            self.activate_pending_node();
        } else if Some(address) == self.profile.bit_rate_object {
            let code = self.objects.number(address).unwrap_or(0) as usize;
            let rate = self.profile.lss.and_then(|lss| lss.bit_rates.get(code));
            self.memory.bit_rate = rate.copied().unwrap_or(self.memory.bit_rate);
            self.pending_bit_rate = self.memory.bit_rate;
        }
    }
}
