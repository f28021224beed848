//! Puts the device back as it was found: in reverse order, by procedure, whatever ended the case.

use fieldproof_link::Stimulus;
use fieldproof_suite::device::Feature;
use fieldproof_suite::model::{Case, Effect, NmtState};
use fieldproof_wire::canopen::Multiplexer;

use crate::found::PLAYED_IN;
use crate::modbus::{Answer, show_bytes};
use crate::pdo_procedure::pdo_parameters;
use crate::sdo::{Outcome, show_abort};
use crate::stop::{Came, Stop};
use crate::tester::{CAN, DEVICE_TYPE, Tester, multiplexer};
use crate::undo::Undo;

/// Objects that are commands, not settings: what they read is not what was written.
const COMMANDS: [u16; 3] = [0x1003, 0x1010, 0x1011];
const CONTROLWORD: Multiplexer = Multiplexer::new(0x6040, 0);

impl Tester<'_> {
    /// The size of an object by the dictionary, in bytes.
    pub(crate) fn size_of(&self, object: Multiplexer) -> Option<usize> {
        let entry = self.dictionary?.entry(object.index, object.sub)?;
        entry.data_type.bits().map(|bits| bits.div_ceil(8) as usize)
    }

    /// The value an object holds before it is written, if it can be read and is not known from before.
    pub(crate) fn value_before(
        &mut self,
        object: Multiplexer,
        size: usize,
    ) -> Result<Option<Vec<u8>>, Stop> {
        let entry = self
            .dictionary
            .and_then(|dictionary| dictionary.entry(object.index, object.sub));
        let readable = entry.is_none_or(|entry| entry.access.readable());
        let is_known = self.undo.is_closed() || self.undo.remembers(object);
        if COMMANDS.contains(&object.index) || !readable || is_known {
            return Ok(None);
        }
        match self.sdo_upload(object, self.device.timing.sdo_response)? {
            Outcome::Done(value) => Ok(Some(
                value.of_size(self.size_of(object).or(Some(size))).to_vec(),
            )),
            Outcome::Refused(_) => Ok(None),
        }
    }

    /// An object is about to be written: its value before is put back after the case, even if the answer to the write
    /// never comes. Whether there is something new to remember.
    pub(crate) fn remember_object(
        &mut self,
        object: Multiplexer,
        before: &Option<Vec<u8>>,
    ) -> bool {
        before
            .as_ref()
            .is_some_and(|bytes| self.undo.push(Undo::Object(object, bytes.clone())))
    }

    /// An object was written: somebody must know how to put it back.
    pub(crate) fn check_remembered(
        &self,
        object: Multiplexer,
        before: &Option<Vec<u8>>,
    ) -> Result<(), Stop> {
        let is_known = before.is_some() || self.undo.remembers(object);
        if is_known || COMMANDS.contains(&object.index) || self.restores_by_steps {
            return Ok(());
        }
        Err(Stop::Bench(format!(
            "{object} was written and cannot be put back, for it cannot be read: the case must say how, under restore"
        )))
    }

    /// What registers hold before they are written, if they can be read.
    pub(crate) fn registers_before(
        &mut self,
        first: u16,
        count: u16,
    ) -> Result<Option<Vec<u16>>, Stop> {
        if self.undo.is_closed() {
            return Ok(None);
        }
        let answer = self.read_row(0x03, first, count)?;
        Ok(answer.and_then(|answer| registers_of(&answer, count)))
    }

    /// What a function that reads `count` of a table answers, if it does.
    pub(crate) fn read_row(
        &mut self,
        function: u8,
        first: u16,
        count: u16,
    ) -> Result<Option<Answer>, Stop> {
        let Some(address) = self.address else {
            return Ok(None);
        };
        let mut pdu = vec![function];
        pdu.extend(first.to_be_bytes());
        pdu.extend(count.to_be_bytes());
        match self.modbus_exchange(address, &pdu, self.device.timing.modbus_response) {
            Err(Stop::Mismatch(_) | Stop::Undecided(_)) => Ok(None),
            answer => answer,
        }
    }

    /// Registers are about to be written: their values before are put back after the case.
    pub(crate) fn remember_registers(&mut self, first: u16, before: &Option<Vec<u16>>) -> bool {
        before
            .as_ref()
            .is_some_and(|values| self.undo.push(Undo::Registers(first, values.clone())))
    }

    /// Registers were written: somebody must know how to put them back.
    pub(crate) fn check_registers_remembered(
        &self,
        first: u16,
        before: &Option<Vec<u16>>,
    ) -> Result<(), Stop> {
        if before.is_some() || self.restores_by_steps {
            return Ok(());
        }
        Err(Stop::Bench(format!(
            "register {first:04X}h was written and cannot be put back, for it cannot be read: the case must say how, under restore"
        )))
    }

    /// Reads what a case says it will change by raw frames.
    pub(crate) fn snapshot(&mut self, case: &Case) -> Result<(), Stop> {
        for object in procedure_order(
            &case
                .restore
                .objects
                .iter()
                .map(|o| multiplexer(*o))
                .collect::<Vec<_>>(),
        ) {
            match self.sdo_upload(object, self.device.timing.sdo_response)? {
                Outcome::Done(value) => {
                    let bytes = value.of_size(self.size_of(object)).to_vec();
                    self.undo.push(Undo::Object(object, bytes));
                }
                Outcome::Refused(code) => {
                    return Err(Stop::undecided(
                        format!(
                            "{object} cannot be read before the case, so it could not be put back"
                        ),
                        "a value",
                        show_abort(code),
                    ));
                }
            }
        }
        for span in &case.restore.registers {
            match self.registers_before(span.first, span.count)? {
                Some(values) => self.undo.push(Undo::Registers(span.first, values)),
                None => return Err(unreadable("register", span.first)),
            };
        }
        for span in &case.restore.coils {
            match self.coils_before(*span)? {
                Some(bytes) => self.undo.push(Undo::Coils(*span, bytes)),
                None => return Err(unreadable("coil", span.first)),
            };
        }
        Ok(())
    }

    /// Puts everything back and reads it back. Nothing interrupts it.
    pub(crate) fn put_back(&mut self, case: &Case) -> Result<(), Stop> {
        self.session.uninterruptible = true;
        let result = self.put_back_all(case);
        self.session.uninterruptible = false;
        self.undo.clear();
        result
    }

    fn put_back_all(&mut self, case: &Case) -> Result<(), Stop> {
        self.stop_sync()?;
        for port in self.undo.take_companions() {
            self.renew_companion(port)?;
        }
        if case.effects.contains(&Effect::Moves) {
            self.stop_drive()?;
        }
        if self.steps_begun {
            self.undo.close(true);
            let played = self.play_restore_steps(case);
            self.undo.close(false);
            played?;
        }
        while let Some(undo) = self.undo.pop() {
            self.undo_one(undo)?;
        }
        self.settle_node()
    }

    fn play_restore_steps(&mut self, case: &Case) -> Result<(), Stop> {
        for step in &case.restore.steps {
            match self.step(&step.value) {
                // The case ended before it saved the value, so it has not changed what the value would put back.
                Ok(()) | Err(Stop::NotSaved(_)) => {}
                Err(stop) => return Err(stop),
            }
        }
        Ok(())
    }

    /// A drive is stopped before anything else is put back.
    fn stop_drive(&mut self) -> Result<(), Stop> {
        if self.session.port(CAN).is_none() {
            return Ok(());
        }
        let has_controlword = self
            .dictionary
            .is_some_and(|dictionary| dictionary.entry(CONTROLWORD.index, 0).is_some());
        if has_controlword {
            self.make_reachable()?;
            self.sdo_download(CONTROLWORD, &[0, 0], self.device.timing.sdo_response)?;
        }
        Ok(())
    }

    fn undo_one(&mut self, undo: Undo) -> Result<(), Stop> {
        match undo {
            Undo::Object(object, bytes) => self.write_back(object, &bytes),
            Undo::Registers(first, values) => self.write_registers_back(first, &values),
            Undo::Coils(span, bytes) => self.switch_coils_back(span, &bytes),
            Undo::PowerOn => {
                self.give(&Stimulus::Power { on: true })?;
                self.watch.boot_up_due = true;
                self.await_boot_up()
            }
            Undo::Condition(name) => self.give(&Stimulus::Condition {
                name,
                active: false,
            }),
            Undo::Setting(name, value) => self.set(&name, value),
            Undo::Line(port, line) => Ok(self.session.lane().set_line(port, line)?),
            Undo::Companion(port) => self.renew_companion(port),
        }
    }

    fn write_back(&mut self, object: Multiplexer, bytes: &[u8]) -> Result<(), Stop> {
        self.make_reachable()?;
        let within = self.device.timing.sdo_response;
        if let Outcome::Done(present) = self.sdo_upload(object, within)?
            && present.of_size(Some(bytes.len())) == bytes
        {
            return Ok(());
        }
        self.prepare_pdo(object)?;
        let name = object.to_string();
        if let Outcome::Refused(code) = self.sdo_download(object, bytes, within)? {
            return Err(not_put_back(&name, &show_bytes(bytes), &show_abort(code)));
        }
        match self.sdo_upload(object, within)? {
            Outcome::Done(present) if present.of_size(Some(bytes.len())) == bytes => Ok(()),
            Outcome::Done(present) => {
                let present = show_bytes(present.of_size(Some(bytes.len())));
                Err(not_put_back(&name, &show_bytes(bytes), &present))
            }
            Outcome::Refused(code) => {
                Err(not_put_back(&name, &show_bytes(bytes), &show_abort(code)))
            }
        }
    }

    fn write_registers_back(&mut self, first: u16, values: &[u16]) -> Result<(), Stop> {
        let count = values.len() as u16;
        let name = format!("register {first:04X}h");
        if self.registers_before(first, count)?.as_deref() == Some(values) {
            return Ok(());
        }
        let Some(address) = self.address else {
            return Ok(());
        };
        for (register, value) in (first..=u16::MAX).zip(values) {
            let mut pdu = vec![0x06];
            pdu.extend(register.to_be_bytes());
            pdu.extend(value.to_be_bytes());
            self.modbus_exchange(address, &pdu, self.device.timing.modbus_response)?;
        }
        match self.registers_before(first, count)? {
            Some(present) if present == values => Ok(()),
            present => Err(not_put_back(
                &name,
                &format!("{values:04X?}"),
                &format!("{present:04X?}"),
            )),
        }
    }

    /// Brings the node into a state in which SDO works.
    pub(crate) fn make_reachable(&mut self) -> Result<(), Stop> {
        if self.watch.boot_up_due {
            self.await_boot_up()?;
        }
        let sdo_works = matches!(
            self.watch.state(),
            Some(NmtState::PreOperational | NmtState::Operational)
        );
        if !sdo_works && self.claims(Feature::NmtSlave) {
            self.command_into(NmtState::PreOperational)?;
            let settled = self.session.now() + self.device.timing.nmt_transition;
            self.session.collect_until(settled)?;
        }
        Ok(())
    }

    /// Brings the node back into the state that cases find it in.
    fn settle_node(&mut self) -> Result<(), Stop> {
        if !self.is_nmt_slave_here() {
            return Ok(());
        }
        if self.watch.boot_up_due {
            self.await_boot_up()?;
        }
        if self.watch.state() != Some(PLAYED_IN) {
            self.command_into(PLAYED_IN)?;
            let settled = self.session.now() + self.device.timing.nmt_transition;
            self.session.collect_until(settled)?;
        }
        self.give_heartbeat_back()
    }

    /// Waits for the boot-up of a node that was reset or powered. One that leaves it out but answers again is back all
    /// the same: that it was left out is for the cases to judge.
    pub(crate) fn await_boot_up(&mut self) -> Result<(), Stop> {
        if self.node.is_none() {
            // Nothing tells when such a device is there again; it may take as long as it promises.
            let patience = self.session.last_sent().end + self.device.timing.boot_up;
            self.watch.boot_up_due = false;
            return self.session.collect_until(patience);
        }
        let id = self.identifier(fieldproof_wire::canopen::Service::ErrorControl)?;
        let within = self.device.timing.boot_up;
        let booted = self.first_frame(fieldproof_can::Id::Standard(id), within)?;
        self.watch.boot_up_due = false;
        match booted {
            Some((_, received)) => {
                self.watch.booted(received.at);
                Ok(())
            }
            None => match self.sdo_upload(DEVICE_TYPE, self.device.timing.sdo_response) {
                Ok(_) => {
                    self.watch.booted(self.session.now());
                    Ok(())
                }
                Err(Stop::Mismatch(_)) => Err(Stop::mismatch(
                    "the node does not boot again",
                    format!("a boot-up within {}", crate::limits::show(within)),
                    "nothing, and no answer to an SDO request",
                    Came::Silence,
                )),
                Err(stop) => Err(stop),
            },
        }
    }
}

fn unreadable(what: &str, address: u16) -> Stop {
    Stop::undecided(
        format!(
            "{what} {address:04X}h cannot be read before the case, so it could not be put back"
        ),
        "a value",
        "no value",
    )
}

fn registers_of(answer: &Answer, count: u16) -> Option<Vec<u16>> {
    let (head, data) = answer.pdu.split_first_chunk::<2>()?;
    let expected = usize::from(count) * 2;
    (*head == [0x03, expected as u8] && data.len() == expected).then(|| {
        data.as_chunks::<2>()
            .0
            .iter()
            .map(|pair| u16::from_be_bytes(*pair))
            .collect()
    })
}

pub(crate) fn not_put_back(what: &str, expected: &str, actual: &str) -> Stop {
    Stop::mismatch(
        format!("{what} could not be put back"),
        expected,
        actual,
        Came::Other,
    )
}

/// The order in which objects are remembered, so that in reverse the entries of a mapping come before their count, and
/// the COB-ID that enables the PDO comes last.
fn procedure_order(objects: &[Multiplexer]) -> Vec<Multiplexer> {
    let mut ordered = objects.to_vec();
    ordered.sort_by_key(|object| match (pdo_parameters(object.index), object.sub) {
        (Some(communication), 1) if communication == object.index => 0,
        (Some(communication), _) if communication == object.index => 1,
        (Some(_), 0) => 2,
        (Some(_), _) => 3,
        (None, _) => 4,
    });
    ordered
}
