//! The procedure for changing a PDO (CiA 301): disable it, clear the count of its mapping, write, enable it.

use fieldproof_wire::canopen::Multiplexer;

use crate::sdo::Outcome;
use crate::stop::Stop;
use crate::tester::Tester;

/// Bit 31 of a PDO's COB-ID: the PDO does not exist.
const DISABLED: u32 = 1 << 31;

/// The communication parameter of the PDO that `index` belongs to, by the index ranges of CiA 301.
pub(crate) const fn pdo_parameters(index: u16) -> Option<u16> {
    match index {
        0x1400..=0x15FF | 0x1800..=0x19FF => Some(index),
        0x1600..=0x17FF | 0x1A00..=0x1BFF => Some(index - 0x200),
        _ => None,
    }
}

impl Tester<'_> {
    /// Before a parameter of a PDO is written back: the PDO is disabled, and the count of its mapping cleared if an
    /// entry is to be written; both to be put back at the end.
    pub(crate) fn prepare_pdo(&mut self, object: Multiplexer) -> Result<(), Stop> {
        let Some(communication) = pdo_parameters(object.index) else {
            return Ok(());
        };
        let enabled = Multiplexer::new(communication, 1);
        let enabled_before = self.write_now(
            enabled,
            |bytes| cob_id(bytes) & DISABLED == 0,
            |bytes| (cob_id(bytes) | DISABLED).to_le_bytes().to_vec(),
        )?;
        let count = Multiplexer::new(object.index, 0);
        let is_entry = object.index != communication && object.sub != 0;
        let counted_before = match is_entry {
            true => self.write_now(
                count,
                |bytes| bytes.iter().any(|byte| *byte != 0),
                |_| vec![0],
            )?,
            false => None,
        };
        // What is pushed last comes back last: the count, then the COB-ID that enables the PDO.
        if let Some(bytes) = counted_before {
            self.undo.push_last(count, bytes);
        }
        if let Some(bytes) = enabled_before
            && object != enabled
        {
            self.undo.push_last(enabled, bytes);
        }
        Ok(())
    }

    /// Writes an object if what it holds makes that necessary, and gives what it held.
    fn write_now(
        &mut self,
        object: Multiplexer,
        needed: impl Fn(&[u8]) -> bool,
        value: impl Fn(&[u8]) -> Vec<u8>,
    ) -> Result<Option<Vec<u8>>, Stop> {
        let within = self.device.timing.sdo_response;
        let Outcome::Done(present) = self.sdo_upload(object, within)? else {
            return Ok(None);
        };
        let present = present.of_size(self.size_of(object)).to_vec();
        if !needed(&present) {
            return Ok(None);
        }
        self.sdo_download(object, &value(&present), within)?;
        Ok(Some(present))
    }
}

fn cob_id(bytes: &[u8]) -> u32 {
    bytes
        .first_chunk::<4>()
        .map_or(DISABLED, |bytes| u32::from_le_bytes(*bytes))
}
