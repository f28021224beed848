//! Bit rates that the EDS of a device claims.

use fieldproof_suite::Columns;
use fieldproof_suite::device::{DeviceDescription, PortDescription};

use super::Known;

/// Table 0 of CiA 305 in kbit/s, by index; index 5 is reserved.
const TABLE: [(u32, u8); 8] = [
    (1000, 0),
    (800, 1),
    (500, 2),
    (250, 3),
    (125, 4),
    (50, 6),
    (20, 7),
    (10, 8),
];

/// Those that LSS can name, from the highest. Of `others` the present one is none.
pub(super) fn bit_rates(
    device: &DeviceDescription,
    known: Known<'_>,
    others: bool,
) -> Option<Vec<Columns>> {
    let PortDescription::Can { bit_rate } = device.ports.get("can")? else {
        return None;
    };
    let rates = known.bit_rates_kbit_per_s?;
    let mut table = TABLE.iter();
    let (present, present_index) = table.find(|(rate, _)| *rate == bit_rate / 1000)?;
    let claimed = TABLE
        .into_iter()
        .filter(|(rate, _)| rates.contains(rate) && !(others && rate == present));
    let columns = claimed
        .map(|(rate, index)| {
            vec![
                ("", format!("{rate} kbit/s")),
                ("-index", index.to_string()),
                ("-before", format!("{present} kbit/s")),
                ("-before-index", present_index.to_string()),
            ]
        })
        .collect();
    Some(columns)
}
