//! Bit rates that the EDS of a device claims.

use fieldproof_suite::Columns;

use super::Described;

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
pub(super) fn bit_rates(described: &Described<'_>, others: bool) -> Vec<Columns> {
    let index_of = |wanted| TABLE.iter().find(|(rate, _)| *rate == wanted);
    let Some((present, present_index)) = described.bit_rate_kbit_per_s.and_then(index_of) else {
        return Vec::new();
    };
    let claimed = TABLE.into_iter().filter(|(rate, _)| {
        described.bit_rates_kbit_per_s.contains(rate) && !(others && rate == present)
    });
    claimed
        .map(|(rate, index)| {
            vec![
                ("", format!("{rate} kbit/s")),
                ("-index", index.to_string()),
                ("-before", format!("{present} kbit/s")),
                ("-before-index", present_index.to_string()),
            ]
        })
        .collect()
}
