//! Who is on a network, over LSS.
//!
//! A slave tells its identity only in configuration, to which all slaves are switched at once, or one by its identity.
//! Two that answer an inquiry together would disturb the bus, so slaves are inquired only where at most one can answer;
//! those without a node-ID are told apart by fastscan.

use std::time::Duration;

use fieldproof_link::LinkError;
use fieldproof_wire::canopen::NodeId;
use fieldproof_wire::canopen::lss::{BitCheck, FastScan, IdentityPart, Request, Response};

use super::bus::{Bus, News};

/// Nobody has more slaves without a node-ID at once.
const MOST_UNCONFIGURED: usize = 127;

/// Fastscan asks 32 times a part and hears nothing half the time: each silence may last this part of an answer's time.
const FAST_SCAN_SHARE: u32 = 10;

/// What LSS gave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LssFound {
    /// These slaves.
    Slaves(Vec<LssSlave>),
    /// Nobody was inquired: this many nodes would answer at once.
    TooMany(usize),
}

/// What a slave says over LSS.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct LssSlave {
    /// Vendor, product, revision, serial number.
    pub identity: [Option<u32>; 4],
    /// Its node-ID; `None` if it has none or does not say.
    pub node: Option<NodeId>,
}

/// Asks the slaves for their identity. All are waiting again afterwards.
pub(super) fn inquire(
    bus: &mut Bus<'_>,
    nodes: usize,
    unconfigured: bool,
    timeout: Duration,
) -> Result<LssFound, LinkError> {
    let mut slaves = Vec::new();
    if unconfigured {
        while slaves.len() < MOST_UNCONFIGURED
            && let Some(identity) = fast_scan(bus, timeout)?
        {
            let identity = identity.map(Some);
            slaves.push(LssSlave {
                identity,
                node: None,
            });
        }
        wait(bus)?;
    }
    let others = nodes + usize::from(unconfigured && slaves.is_empty());
    if others > 1 {
        return Ok(match slaves.is_empty() {
            true => LssFound::TooMany(others),
            false => LssFound::Slaves(slaves),
        });
    }
    // Those that fastscan found would answer, too.
    if slaves.is_empty() {
        slaves.extend(single(bus, timeout)?);
    }
    Ok(LssFound::Slaves(slaves))
}

/// The identity of the only slave there is.
fn single(bus: &mut Bus<'_>, timeout: Duration) -> Result<Option<LssSlave>, LinkError> {
    bus.send(
        Request::SwitchGlobal {
            configuration: true,
        }
        .encode(),
    )?;
    let mut slave = LssSlave::default();
    let mut has_answered = false;
    for part in IdentityPart::ALL {
        let answer = ask(
            bus,
            Request::InquireIdentity(part),
            timeout,
            |response| match response {
                Response::InquireIdentity { part: of, value } if of == part => Some(value),
                _ => None,
            },
        )?;
        has_answered |= answer.is_some();
        slave.identity[usize::from(part.number())] = answer;
        // Who is silent once is no slave.
        if !has_answered {
            break;
        }
    }
    if has_answered {
        let node = ask(
            bus,
            Request::InquireNodeId,
            timeout,
            |response| match response {
                Response::InquireNodeId(node) => Some(node),
                _ => None,
            },
        )?;
        slave.node = node.flatten();
    }
    wait(bus)?;
    Ok(has_answered.then_some(slave))
}

/// The identity of one slave without a node-ID, which is in configuration then; `None` if none takes part any more.
fn fast_scan(bus: &mut Bus<'_>, timeout: Duration) -> Result<Option<[u32; 4]>, LinkError> {
    let begin = FastScan {
        number: 0,
        bit_check: None,
        part: IdentityPart::VendorId,
        next: IdentityPart::VendorId,
    };
    if !compare(bus, begin, timeout)? {
        return Ok(None);
    }
    let mut identity = [0; 4];
    for part in IdentityPart::ALL {
        let mut step = FastScan {
            number: 0,
            bit_check: None,
            part,
            next: part,
        };
        for bit in (0..=BitCheck::MAX.raw()).rev() {
            step.bit_check = BitCheck::new(bit);
            // Nobody has a 0 there.
            if !compare(bus, step, timeout / FAST_SCAN_SHARE)? {
                step.number |= 1 << bit;
            }
        }
        step.next = IdentityPart::from_number(part.number() + 1).unwrap_or(IdentityPart::VendorId);
        if !compare(bus, step, timeout)? {
            return Ok(None);
        }
        identity[usize::from(part.number())] = step.number;
    }
    Ok(Some(identity))
}

/// Whether a slave answers to `step`. All that answer do so with the same frame, one after the other: the last of them is
/// waited for, too, so that none is taken for an answer to the next step.
fn compare(bus: &mut Bus<'_>, step: FastScan, timeout: Duration) -> Result<bool, LinkError> {
    let answer = ask(bus, Request::FastScan(step), timeout, |response| {
        (response == Response::IdentifySlave).then_some(())
    })?;
    if answer.is_some() {
        bus.listen(timeout)?;
    }
    Ok(answer.is_some())
}

/// All slaves are waiting from now on.
fn wait(bus: &mut Bus<'_>) -> Result<(), LinkError> {
    let waiting = Request::SwitchGlobal {
        configuration: false,
    };
    bus.send(waiting.encode()).map(drop)
}

/// The first answer to `request` that `wanted` takes, if one comes in time.
fn ask<T>(
    bus: &mut Bus<'_>,
    request: Request,
    timeout: Duration,
    wanted: impl Fn(Response) -> Option<T>,
) -> Result<Option<T>, LinkError> {
    let frame = request.encode();
    let mut until = bus.send(frame)? + timeout;
    while let Some(news) = bus.receive(until)? {
        match news {
            News::Left(at, left) if left == frame => until = at + timeout,
            News::Left(..) => {}
            News::Came(came) => {
                if let Some(answer) = Response::parse(&came).ok().and_then(&wanted) {
                    return Ok(Some(answer));
                }
            }
        }
    }
    Ok(None)
}
