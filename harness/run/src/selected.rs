//! Objects that a suite chooses by what they are.

use fieldproof_dictionary::{DataType, Dictionary};
use fieldproof_suite::model::{SdoObject, SdoRead, SdoWrite, Step};
use fieldproof_wire::canopen::Multiplexer;

use crate::stop::Stop;
use crate::tester::{Tester, multiplexer};

/// The object that `chosen` is on this device, if it has one.
fn select(chosen: SdoObject, dictionary: Option<&Dictionary>) -> Option<Multiplexer> {
    match chosen {
        SdoObject::Address(address) => Some(multiplexer(address)),
        SdoObject::WritableDomain => {
            let mut entries = dictionary?.entries();
            let (index, sub, _) = entries.find(|(_, _, entry)| {
                let access = entry.access;
                entry.data_type == DataType::Domain && access.readable() && access.writable()
            })?;
            Some(Multiplexer::new(index, sub))
        }
    }
}

/// What a step asks for that the device has no object for.
pub(crate) fn missing_object(step: &Step, dictionary: Option<&Dictionary>) -> Option<&'static str> {
    let (Step::SdoRead(SdoRead { object, .. }) | Step::SdoWrite(SdoWrite { object, .. })) = step
    else {
        return None;
    };
    match select(*object, dictionary) {
        Some(_) => None,
        None => Some("the dictionary has no DOMAIN that can be read and written"),
    }
}

impl Tester<'_> {
    /// The object that `chosen` is; what it was chosen to be is noted once a case.
    pub(crate) fn resolve(&mut self, chosen: SdoObject) -> Result<Multiplexer, Stop> {
        let Some(object) = select(chosen, self.dictionary) else {
            return Err(Stop::Bench(
                "the dictionary has no such object as the step asks for".into(),
            ));
        };
        if chosen == SdoObject::WritableDomain {
            let note = format!("writable-domain is {object}");
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
        Ok(object)
    }
}
