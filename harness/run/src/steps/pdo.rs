//! `sync`, `start-sync`, `stop-sync`, `expect-tpdo`, `send-rpdo`.

use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_suite::model::{ExpectTpdo, SendRpdo, StartSync, Sync};
use fieldproof_wire::canopen::{PdoNumber, Service, cob_id};

use crate::companions::SyncProducer;
use crate::limits::show;
use crate::modbus::show_bytes;
use crate::stop::{Came, Stop};
use crate::tester::Tester;
use crate::value::check_decode;

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
        Ok(())
    }

    pub(super) fn start_sync(&mut self, step: &StartSync) -> Result<(), Stop> {
        self.stop_sync()?;
        let port = self.can_port()?;
        let line = self.session.line(port);
        let now = self.session.now();
        let producer = SyncProducer::new(line, now, step.period);
        self.sync_producer = Some(self.session.lane().attach(port, Box::new(producer)));
        Ok(())
    }

    pub(crate) fn stop_sync(&mut self) -> Result<(), Stop> {
        if let Some(producer) = self.sync_producer.take() {
            self.session.lane().detach(producer);
        }
        Ok(())
    }

    pub(super) fn expect_tpdo(&mut self, step: &ExpectTpdo) -> Result<(), Stop> {
        let id = Id::Standard(self.identifier(Service::TransmitPdo(pdo_number(step.number)?))?);
        let within = step.within.unwrap_or(PDO_PATIENCE);
        let Some((frame, received)) = self.first_frame(id, within)? else {
            return Err(Stop::mismatch(
                format!("TPDO{} does not come", step.number),
                format!("within {}", show(within)),
                "nothing",
                Came::Silence,
            ));
        };
        check_pdo(step, &frame)?;
        if step.within.is_some() {
            self.measure_response("PDO response time", &received, within)?;
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
                    format!("TPDO{} stops", step.number),
                    format!("the next within {}", show(patience)),
                    "nothing",
                    Came::Silence,
                ));
            };
            check_pdo(step, &frame)?;
            periods.push(received.at.since(last));
            last = received.at;
        }
        let port = self.can_port()?;
        let uncertainty = self.session.uncertainty(port) * 2;
        self.judge_periods("PDO period", &periods, limit, step.judge, uncertainty)
    }

    pub(super) fn send_rpdo(&mut self, step: &SendRpdo) -> Result<(), Stop> {
        let id = self.identifier(Service::ReceivePdo(pdo_number(step.number)?))?;
        let frame = Frame::data(id, &step.data.0)
            .ok_or_else(|| Stop::Bench("a PDO holds at most 8 bytes".into()))?;
        self.send_frame(frame)
    }
}

fn check_pdo(step: &ExpectTpdo, frame: &Frame) -> Result<(), Stop> {
    if let Some(pattern) = &step.data
        && !pattern.0.matches(frame.bytes())
    {
        return Err(Stop::mismatch(
            format!("TPDO{} carries something else", step.number),
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
