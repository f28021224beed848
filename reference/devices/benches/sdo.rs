//! What one expedited SDO read costs a reference device: request in, answer out.

use divan::{Bencher, black_box};
use fieldproof_can::{Frame, StandardId};
use fieldproof_devices::Settings;
use fieldproof_link::{Instant, Outbox, Participant, Reception};
use std::time::Duration;

fn main() {
    divan::main();
}

fn ready(kind: &str) -> Option<Box<dyn Participant>> {
    let mut device = (fieldproof_devices::kind(kind)?.build)(&Settings::default()).ok()?;
    let mut out = Outbox::default();
    device.wake(Instant::START + Duration::from_millis(100), &mut out);
    Some(device)
}

#[divan::bench(args = [("kinco-servo", 0x601), ("liaomiao-encoder", 0x620)])]
fn expedited_upload(bencher: Bencher, (kind, identifier): (&str, u16)) {
    let (Some(mut device), Some(identifier)) = (ready(kind), StandardId::new(identifier)) else {
        return;
    };
    let request = Frame::of_eight(identifier, [0x40, 0x00, 0x10, 0, 0, 0, 0, 0]);
    let mut now = Instant::START + Duration::from_millis(200);
    let mut out = Outbox::default();
    bencher.bench_local(|| {
        let reception = Reception::Frame(black_box(request));
        device.receive(now, 0, reception, &mut out);
        now = device.wake_at().unwrap_or(now);
        device.wake(now, &mut out);
        out.drain().count()
    });
}
