//! Who the device says it is, read before the first case. Nothing is judged here; suites do that.

use fieldproof_record::{Event, Identity, IdentityPart};
use fieldproof_suite::device::{Feature, FunctionCode};
use fieldproof_suite::identity::Claim;
use fieldproof_wire::modbus::pdu::ReadDeviceId;
use fieldproof_wire::modbus::{Request, Response};

use crate::sdo::Outcome;
use crate::stop::Stop;
use crate::tester::{Tester, multiplexer};

/// Function 43 with MEI type 14.
const IDENTIFICATION: FunctionCode = FunctionCode {
    function: 0x2B,
    sub_function: Some(0x0E),
};

/// A device with more than this in its basic identification does not come to an end.
const MOST_PARTS: usize = 8;

impl Tester<'_> {
    /// Reads what the device says of itself, as far as its description claims that it can be asked.
    pub(crate) fn read_identity(&mut self) {
        let mut parts = Vec::new();
        if self.node.is_some() && self.claims(Feature::SdoServer) {
            for claim in Claim::ALL {
                parts.extend(self.read_claim(claim));
            }
        }
        if self.claims_identification() {
            self.read_identification(&mut parts);
        }
        if !parts.is_empty() {
            let at_ns = self.session.now().as_nanos();
            self.session
                .emit(Event::Identity(Box::new(Identity { at_ns, parts })));
        }
        self.session.begin_case();
    }

    fn claims_identification(&self) -> bool {
        let modbus = self.device.modbus.as_ref();
        self.address.is_some()
            && self.session.port(crate::tester::SERIAL).is_some()
            && modbus.is_some_and(|modbus| modbus.claims(IDENTIFICATION))
    }

    /// `None` where the device neither has the object by its dictionary nor claims anything of it.
    fn read_claim(&mut self, claim: Claim) -> Option<IdentityPart> {
        let object = claim.object();
        let described = self.described(claim);
        let is_there = self
            .dictionary
            .is_none_or(|dictionary| dictionary.entry(object.index, object.sub).is_some());
        if !is_there && described.is_none() {
            return None;
        }
        let within = self.device.timing.sdo_response;
        let (read, unread) = match self.sdo_upload(multiplexer(object), within) {
            Ok(Outcome::Done(value)) => {
                let value = value.of_size((!claim.is_text()).then_some(4));
                (Some(shown(claim, value)), None)
            }
            Ok(Outcome::Refused(code)) => (None, Some(format!("refused with {code}"))),
            Err(stop) => (None, Some(why(stop))),
        };
        // A transfer that broke off must not be in the way of the first case.
        let _ = self.abort_open_transfer();
        Some(IdentityPart {
            name: claim.name().to_owned(),
            object: format!("{:04X}h:{:02X}", object.index, object.sub),
            read,
            unread,
            described,
        })
    }

    fn described(&self, claim: Claim) -> Option<String> {
        let identity = &self.device.identity;
        let number = match claim {
            Claim::VendorId => &identity.vendor_id,
            Claim::ProductCode => &identity.product_code,
            Claim::RevisionNumber => &identity.revision_number,
            Claim::SerialNumber => &identity.serial_number,
            Claim::DeviceName => return text_of(identity.device_name.as_ref()),
            Claim::HardwareVersion => return text_of(identity.hardware_version.as_ref()),
            Claim::SoftwareVersion => return text_of(identity.software_version.as_ref()),
        };
        number.as_ref().map(|number| hexadecimal(number.value))
    }

    fn read_identification(&mut self, parts: &mut Vec<IdentityPart>) {
        let described = self.device.identity.modbus.clone().unwrap_or_default();
        let mut names = [
            ("vendor-name", described.vendor_name, None),
            ("product-code", described.product_code, None),
            ("revision", described.revision, None),
        ];
        let mut unread = None;
        let mut object = 0;
        for _ in 0..MOST_PARTS {
            match self.ask_identification(object) {
                Ok((found, next)) => {
                    for (id, value) in found {
                        if let Some(part) = names.get_mut(usize::from(id)) {
                            part.2 = Some(value);
                        }
                    }
                    match next {
                        Some(next) => object = next,
                        None => break,
                    }
                }
                Err(reason) => {
                    unread = Some(reason);
                    break;
                }
            }
        }
        for (id, (name, described, read)) in names.into_iter().enumerate() {
            parts.push(IdentityPart {
                name: name.to_owned(),
                object: format!("43/14 object {id:02X}h"),
                unread: read.is_none().then(|| unread.clone()).flatten(),
                read,
                described,
            });
        }
    }

    /// The objects from `object` on, and where to go on.
    #[allow(clippy::type_complexity, reason = "told once, used once")]
    fn ask_identification(
        &mut self,
        object: u8,
    ) -> Result<(Vec<(u8, String)>, Option<u8>), String> {
        let Some(address) = self.address else {
            return Err("no address".to_owned());
        };
        let request = Request::ReadDeviceIdentification {
            read: ReadDeviceId::Basic,
            object,
        };
        let within = self.device.timing.modbus_response;
        let answer = self
            .modbus_exchange(address, &request.encode(), within)
            .map_err(why)?
            .ok_or("no answer")?;
        match Response::parse(&answer.pdu) {
            Ok(Response::ReadDeviceIdentification(part)) => {
                let objects = part.objects.iter().map(|it| (it.id, text(&it.value)));
                Ok((objects.collect(), part.next))
            }
            _ => Err("another answer".to_owned()),
        }
    }
}

fn why(stop: Stop) -> String {
    match stop {
        Stop::Mismatch(mismatch) | Stop::Undecided(mismatch) => mismatch.what,
        Stop::Bench(reason) | Stop::NotSaved(reason) => reason,
        Stop::Link(error) => error.to_string(),
        Stop::Interrupted => "interrupted".to_owned(),
    }
}

fn text_of(claimed: Option<&fieldproof_suite::model::Located<String>>) -> Option<String> {
    claimed.map(|claimed| claimed.value.clone())
}

fn hexadecimal(number: u32) -> String {
    format!("{number:08X}h")
}

fn shown(claim: Claim, bytes: &[u8]) -> String {
    match <[u8; 4]>::try_from(bytes) {
        Ok(bytes) if !claim.is_text() => hexadecimal(u32::from_le_bytes(bytes)),
        _ => text(bytes),
    }
}

/// What can be read of it; a dot for anything else. Zeros at the end fill up, and say nothing.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().rposition(|byte| *byte != 0);
    let bytes = &bytes[..end.map_or(0, |end| end + 1)];
    let shown = |byte: &u8| match byte {
        b' '..=b'~' => char::from(*byte),
        _ => '.',
    };
    bytes.iter().map(shown).collect()
}
