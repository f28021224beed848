//! `sync`, `start-sync`, `stop-sync`, `expect-tpdo`, `send-rpdo`.

use std::time::Duration;

use fieldproof_can::{Frame, Id, StandardId};
use fieldproof_link::Instant;
use fieldproof_suite::model::{Carried, ExpectTpdo, PdoName, SendRpdo, StartSync, Sync};
use fieldproof_wire::canopen::{PdoNumber, Service, cob_id};
use fieldproof_wire::describe::describe_frame;

use crate::companions::SyncProducer;
use crate::limits::show;
use crate::modbus::show_bytes;
use crate::session::Message;
use crate::stop::{Came, Stop};
use crate::tester::Tester;
use crate::value::{check_decode, encode};

/// A PDO that no limit is given for is waited for this long.
const PDO_PATIENCE: Duration = Duration::from_secs(1);

impl Tester<'_> {
    pub(super) fn sync(&mut self, step: &Sync) -> Result<(), Stop> {
        let port = self.can_port()?;
        let Some(frame) = Frame::data(cob_id(Service::Sync, None), &[]) else {
            return Ok(());
        };
        let mut at = self.session.now();
        for _ in 0..step.count {
            self.session.send_frame_at(port, at, frame)?;
            at = at + step.period;
        }
        self.history.add(describe_frame(&frame));
        Ok(())
    }

    pub(super) fn start_sync(&mut self, step: &StartSync) -> Result<(), Stop> {
        self.stop_sync()?;
        let port = self.can_port()?;
        let line = self.session.line(port);
        let now = self.session.now();
        let producer = SyncProducer::new(line, now, step.period);
        self.sync_period = Some(step.period);
        self.sync_producer = Some(self.session.lane().attach(port, Box::new(producer)));
        self.history
            .add(format!("SYNC every {}", show(step.period)));
        Ok(())
    }

    pub(crate) fn stop_sync(&mut self) -> Result<(), Stop> {
        if let Some(producer) = self.sync_producer.take() {
            self.session.lane().detach(producer);
        }
        self.sync_period = None;
        Ok(())
    }

    pub(super) fn expect_tpdo(&mut self, step: &ExpectTpdo) -> Result<(), Stop> {
        let id = Id::Standard(match step.pdo {
            PdoName::Number(number) => {
                self.identifier(Service::TransmitPdo(pdo_number(number)?))?
            }
            PdoName::Identifier(identifier) => standard(identifier)?,
        });
        let expected = self.carried(&step.carries)?;
        let within = step.within.unwrap_or(PDO_PATIENCE);
        let Some((frame, received)) = self.first_frame(id, within)? else {
            return Err(Stop::mismatch(
                format!("{} does not come", show_pdo(step.pdo)),
                format!("within {}", show(within)),
                "nothing",
                Came::Silence,
            ));
        };
        check_pdo(step, &expected, &frame)?;
        if step.within.is_some() {
            self.measure_response("PDO response time", &received, within)?;
        }
        if step.syncs.is_some() {
            return self.count_syncs(step, id, received.at, &expected);
        }
        let Some(limit) = step.period else {
            return Ok(());
        };
        let mut periods = Vec::new();
        let mut last = received.at;
        while periods.len() < step.count as usize {
            let patience = limit.nominal * 2 + limit.tolerance;
            let within = (last + patience).since(self.session.last_sent().end);
            let Some((frame, received)) = self.first_frame(id, within)? else {
                return Err(Stop::mismatch(
                    format!("{} stops", show_pdo(step.pdo)),
                    format!("the next within {}", show(patience)),
                    "nothing",
                    Came::Silence,
                ));
            };
            check_pdo(step, &expected, &frame)?;
            periods.push(received.at.since(last));
            last = received.at;
        }
        let port = self.can_port()?;
        let uncertainty = self.session.uncertainty(port) * 2;
        self.judge_periods("PDO period", &periods, limit, step.judge, uncertainty)
    }

    /// Counts the SYNCs from one TPDO to the next.
    fn count_syncs(
        &mut self,
        step: &ExpectTpdo,
        id: Id,
        first: Instant,
        expected: &[u8],
    ) -> Result<(), Stop> {
        let syncs = step.syncs.unwrap_or(1);
        let Some(period) = self.sync_period else {
            return Err(Stop::Bench("no SYNC is sent".into()));
        };
        let sync = Id::Standard(cob_id(Service::Sync, None));
        let mut last = first;
        for _ in 0..step.count {
            let patience = period * (syncs + 2);
            let within = (last + patience).since(self.session.last_sent().end);
            let Some((frame, received)) = self.first_frame(id, within)? else {
                return Err(Stop::mismatch(
                    format!("{} stops", show_pdo(step.pdo)),
                    format!("the next after {syncs} SYNCs"),
                    format!("nothing with {} SYNCs", syncs + 1),
                    Came::Silence,
                ));
            };
            check_pdo(step, expected, &frame)?;
            let between = self.session.count(|other| {
                let counts = other.at > last && other.at < received.at;
                counts && matches!(other.message, Message::Can(frame) if frame.id() == sync)
            });
            if between != syncs as usize {
                return Err(Stop::mismatch(
                    format!(
                        "{} comes after {between} SYNCs, and not after {syncs}",
                        show_pdo(step.pdo)
                    ),
                    format!("after {syncs} SYNCs"),
                    format!("after {between}"),
                    Came::Frame(frame),
                ));
            }
            last = received.at;
        }
        Ok(())
    }

    pub(super) fn send_rpdo(&mut self, step: &SendRpdo) -> Result<(), Stop> {
        let id = match step.pdo {
            PdoName::Number(number) => self.identifier(Service::ReceivePdo(pdo_number(number)?))?,
            PdoName::Identifier(identifier) => standard(identifier)?,
        };
        let data = match &step.data {
            Some(data) => data.0.clone(),
            None => self.carried(&step.carries)?,
        };
        let frame = Frame::data(id, &data)
            .ok_or_else(|| Stop::Bench("a PDO holds at most 8 bytes".into()))?;
        self.send_frame(frame)?;
        self.history.add(describe_frame(&frame));
        Ok(())
    }
}

impl Tester<'_> {
    /// Values one after another, as a PDO carries them.
    fn carried(&self, carries: &[Carried]) -> Result<Vec<u8>, Stop> {
        let mut bytes = Vec::new();
        for carried in carries {
            bytes.extend(encode(
                carried.value_type,
                &carried.value,
                None,
                &self.saved,
            )?);
        }
        Ok(bytes)
    }
}

fn standard(identifier: u16) -> Result<StandardId, Stop> {
    StandardId::new(identifier)
        .ok_or_else(|| Stop::Bench(format!("{identifier:03X} is no identifier of 11 bits")))
}

fn show_pdo(pdo: PdoName) -> String {
    match pdo {
        PdoName::Number(number) => format!("TPDO{number}"),
        PdoName::Identifier(identifier) => format!("the PDO {identifier:03X}"),
    }
}

fn check_pdo(step: &ExpectTpdo, expected: &[u8], frame: &Frame) -> Result<(), Stop> {
    if !step.carries.is_empty() && frame.bytes() != expected {
        return Err(Stop::differs(
            format!("{} carries something else", show_pdo(step.pdo)),
            show_bytes(expected),
            show_bytes(frame.bytes()),
            Came::Frame(*frame),
        ));
    }
    if let Some(pattern) = &step.data
        && !pattern.0.matches(frame.bytes())
    {
        return Err(Stop::differs(
            format!("{} carries something else", show_pdo(step.pdo)),
            pattern.0.to_string(),
            show_bytes(frame.bytes()),
            Came::Frame(*frame),
        ));
    }
    step.decode
        .iter()
        .try_for_each(|rule| check_decode(rule, frame.bytes()))
}

fn pdo_number(number: u8) -> Result<PdoNumber, Stop> {
    PdoNumber::new(number).ok_or_else(|| {
        Stop::Bench(format!(
            "PDO {number} has no predefined identifier; 1 to 4 have"
        ))
    })
}
