//! The suites and device descriptions that the program carries.

include!(concat!(env!("OUT_DIR"), "/embedded.rs"));

/// Every file it carries, by path: `suites/canopen/nmt.yaml`, `devices/kinco-servo/device.yaml`.
pub(crate) fn files() -> impl Iterator<Item = (&'static str, &'static str)> {
    FILES.iter().copied()
}

/// The text of the file at `path`.
pub(crate) fn text(path: &str) -> Option<&'static str> {
    files()
        .find(|(name, _)| *name == path)
        .map(|(_, text)| text)
}
