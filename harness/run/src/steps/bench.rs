//! `stimulate`, `set-bit-rate`: what the bench does beside the bus.

use std::time::Duration;

use fieldproof_link::{Line, PortIndex, Stimulus, StimulusError};
use fieldproof_record::{Event, StimulusEvent};
use fieldproof_suite::model::{CompanionStimulus, PowerAction, Stimulate};

use crate::stop::Stop;
use crate::tester::Tester;
use crate::undo::Undo;

/// How long a power cycle keeps the power off.
const POWER_OFF_TIME: Duration = Duration::from_secs(1);

/// What comes next is nobody's fault if a hand or a command was slow.
fn in_time(taken: Duration, limit: Duration) -> Result<(), Stop> {
    match taken <= limit {
        true => Ok(()),
        false => Err(Stop::undecided(
            "giving the stimulus took too long for what comes next",
            format!("at most {limit:?}"),
            format!("{taken:?}"),
        )),
    }
}

impl Tester<'_> {
    pub(super) fn stimulate(&mut self, step: &Stimulate) -> Result<(), Stop> {
        match step {
            Stimulate::Power(PowerAction::Off) => self.power(false),
            Stimulate::Power(PowerAction::On) => self.power(true),
            Stimulate::Power(PowerAction::Cycle) => {
                self.power(false)?;
                let off_until = self.session.now() + POWER_OFF_TIME;
                self.session.collect_until(off_until)?;
                self.power(true)
            }
            Stimulate::ProcessValue { name, to, within } => {
                let begun = self.session.now();
                self.give(&Stimulus::ProcessValue {
                    name: name.clone(),
                    value: *to,
                })?;
                let taken = self.session.now().since(begun);
                within.map_or(Ok(()), |limit| in_time(taken, limit))
            }
            Stimulate::Condition { name, active } => {
                if *active {
                    self.undo.push(Undo::Condition(name.clone()));
                }
                self.give(&Stimulus::Condition {
                    name: name.clone(),
                    active: *active,
                })
            }
            Stimulate::Setting { name, to } => {
                let before = match name.as_str() {
                    "node" => self.node.map(|node| i64::from(node.raw())),
                    "address" => self.address.map(i64::from),
                    _ => None,
                };
                if let Some(before) = before {
                    self.undo.push(Undo::Setting(name.clone(), before));
                }
                self.set(name, *to)
            }
            Stimulate::Companion { port, stimulus } => self.stimulate_companion(port, stimulus),
        }
    }

    /// What the tester plays himself: put back after the case by taking its power away and giving it again.
    fn stimulate_companion(
        &mut self,
        role: &str,
        stimulus: &CompanionStimulus,
    ) -> Result<(), Stop> {
        let port = self.port(role)?;
        self.undo.push(Undo::Companion(port));
        match stimulus {
            CompanionStimulus::Power(PowerAction::Off) => self.power_companion(port, false),
            CompanionStimulus::Power(PowerAction::On) => self.power_companion(port, true),
            CompanionStimulus::Power(PowerAction::Cycle) => self.renew_companion(port),
            CompanionStimulus::ProcessValue { name, to } => self.give_companion(
                port,
                &Stimulus::ProcessValue {
                    name: name.clone(),
                    value: *to,
                },
            ),
        }
    }

    pub(crate) fn renew_companion(&mut self, port: PortIndex) -> Result<(), Stop> {
        self.power_companion(port, false)?;
        self.power_companion(port, true)
    }

    fn power_companion(&mut self, port: PortIndex, on: bool) -> Result<(), Stop> {
        self.give_companion(port, &Stimulus::Power { on })
    }

    fn give_companion(&mut self, port: PortIndex, stimulus: &Stimulus) -> Result<(), Stop> {
        let at_ns = self.session.now().as_nanos();
        let role = self.session.port_name(port).to_owned();
        let what = format!("{} of what the tester plays on {role}", describe(stimulus));
        self.session.mark_sent();
        let given = self.session.lane().stimulate_companion(port, stimulus);
        given.map_err(|_| Stop::Bench(format!("nothing has: {what}")))?;
        self.history.add(what.clone());
        self.session
            .emit(Event::Stimulus(Box::new(StimulusEvent { at_ns, what })));
        Ok(())
    }

    pub(crate) fn power(&mut self, on: bool) -> Result<(), Stop> {
        if on {
            self.watch.boot_up_due = true;
        } else {
            self.undo.push(Undo::PowerOn);
        }
        self.give(&Stimulus::Power { on })
    }

    /// Sets a switch of the device, and follows what it means for the tester.
    pub(crate) fn set(&mut self, name: &str, value: i64) -> Result<(), Stop> {
        self.give(&Stimulus::Setting {
            name: name.to_owned(),
            value,
        })?;
        match name {
            "address" => self.address = u8::try_from(value).ok(),
            "node" => {
                self.node = u8::try_from(value)
                    .ok()
                    .and_then(fieldproof_wire::canopen::NodeId::new);
            }
            _ => {}
        }
        Ok(())
    }

    pub(crate) fn give(&mut self, stimulus: &Stimulus) -> Result<(), Stop> {
        let at_ns = self.session.now().as_nanos();
        let what = describe(stimulus);
        // What the device does about it may come while it is still being given: an operator takes his time.
        self.session.mark_sent();
        self.session
            .lane()
            .stimulate(stimulus)
            .map_err(|error| match error {
                StimulusError::NotOffered => {
                    Stop::Bench(format!("this bench does not offer: {what}"))
                }
                StimulusError::Failed(reason) => Stop::Bench(format!("{what}: {reason}")),
            })?;
        self.history.add(what.clone());
        self.session
            .emit(Event::Stimulus(Box::new(StimulusEvent { at_ns, what })));
        Ok(())
    }

    pub(super) fn set_bit_rate(&mut self, bit_rate: u32) -> Result<(), Stop> {
        let port = self.can_port()?;
        let before = self.session.line(port);
        self.undo.push(Undo::Line(port, before));
        self.session.lane().set_line(port, Line::Can { bit_rate })?;
        self.history
            .add(format!("{bit_rate} bit/s on the tester's side"));
        Ok(())
    }
}

fn describe(stimulus: &Stimulus) -> String {
    match stimulus {
        Stimulus::Power { on: true } => "power on".into(),
        Stimulus::Power { on: false } => "power off".into(),
        Stimulus::ProcessValue { name, value } => format!("process value {name} = {value}"),
        Stimulus::Condition { name, active: true } => format!("condition {name} begins"),
        Stimulus::Condition {
            name,
            active: false,
        } => format!("condition {name} ends"),
        Stimulus::Setting { name, value } => format!("setting {name} = {value}"),
    }
}
