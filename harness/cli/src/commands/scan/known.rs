//! Which of the devices that there are descriptions of a found one is.

use fieldproof_run::scan::Answers;
use fieldproof_suite::device::{DeviceDescription, PortDescription};

use crate::complaint::Complaint;
use crate::library::Library;
use crate::options::Selection;

/// The descriptions there are.
pub(super) struct Known {
    descriptions: Vec<DeviceDescription>,
    /// What the user says that anything else is.
    given: Option<Given>,
}

struct Given {
    description: DeviceDescription,
    /// As it was given: a name or a folder.
    text: String,
}

impl Known {
    /// Those that the program carries, and the one that the user gives by name or folder.
    pub(super) fn load(given: Option<&str>) -> Result<Known, Complaint> {
        let given = match given {
            None => None,
            Some(text) => {
                let selection = Selection {
                    devices: vec![text.to_owned()],
                    ..Selection::default()
                };
                let devices = Library::load(&selection)?.devices;
                devices.into_iter().next().map(|device| Given {
                    description: device.description,
                    text: text.to_owned(),
                })
            }
        };
        let devices = Library::load(&Selection::default())?.devices;
        Ok(Known {
            descriptions: devices.into_iter().map(|it| it.description).collect(),
            given,
        })
    }

    /// The device that says this of itself over CANopen: the only one whose claims are so. A description that claims no
    /// vendor and product cannot be told from others.
    pub(super) fn over_canopen(&self, answers: Option<&Answers>) -> Option<&DeviceDescription> {
        let recognised = answers.and_then(|answers| self.only(|it| claims(it, answers)));
        recognised.or_else(|| self.given_with(|it| it.canopen.is_some()))
    }

    /// The device whose device identification over Modbus has these objects.
    pub(super) fn over_modbus(&self, objects: &[(u8, String)]) -> Option<&DeviceDescription> {
        let has = |number: u8, claimed: &Option<String>| match claimed {
            None => true,
            Some(claimed) => objects.iter().any(|it| it.0 == number && it.1 == *claimed),
        };
        let recognised = self.only(|it| {
            it.identity.modbus.as_ref().is_some_and(|claims| {
                claims.vendor_name.is_some()
                    && claims.product_code.is_some()
                    && has(0, &claims.vendor_name)
                    && has(1, &claims.product_code)
            })
        });
        recognised.or_else(|| self.given_with(|it| it.modbus.is_some()))
    }

    fn only(&self, is_it: impl Fn(&DeviceDescription) -> bool) -> Option<&DeviceDescription> {
        let given = self.given.iter().map(|given| &given.description);
        // A description that the user gives takes the place of one of its name.
        let carried = self.descriptions.iter().filter(|it| {
            let given = self.given.as_ref();
            given.is_none_or(|given| given.description.device != it.device)
        });
        let mut matching = given.chain(carried).filter(|it| is_it(it));
        let first = matching.next()?;
        matching.next().is_none().then_some(first)
    }

    fn given_with(&self, has_side: fn(&DeviceDescription) -> bool) -> Option<&DeviceDescription> {
        let given = self.given.as_ref().map(|given| &given.description);
        given.filter(|it| has_side(it))
    }

    /// The description of that name.
    pub(super) fn named(&self, name: &str) -> Option<&DeviceDescription> {
        let given = self.given.as_ref().map(|given| &given.description);
        let mut all = given.into_iter().chain(&self.descriptions);
        all.find(|it| it.device == name)
    }

    /// The folder of the description of that name, if the user gave it by its folder.
    pub(super) fn folder(&self, name: &str) -> Option<&str> {
        let given = self.given.as_ref()?;
        let is_folder = given.text != given.description.device;
        (is_folder && given.description.device == name).then_some(given.text.as_str())
    }
}

/// Whether a description claims a vendor and a product, and everything it claims is as the device says.
fn claims(description: &DeviceDescription, answers: &Answers) -> bool {
    let claims = &description.identity;
    let [vendor, product, ..] = answers.identity;
    let number = |claim: &Option<_>, said: Option<u32>| -> bool {
        let claim: &Option<fieldproof_suite::model::Located<u32>> = claim;
        claim.as_ref().is_some_and(|it| Some(it.value) == said)
    };
    let name = claims.device_name.as_ref();
    number(&claims.vendor_id, vendor)
        && number(&claims.product_code, product)
        && name.is_none_or(|name| Some(&name.value) == answers.name.as_ref())
}

/// The role of the port through which a device was found.
pub(super) fn role<'d>(
    description: &'d DeviceDescription,
    can: bool,
    link: &str,
) -> Option<&'d str> {
    let is_modbus_tcp = link.starts_with("tcp:") && !link.contains("framing=rtu");
    let preferred = match (can, is_modbus_tcp) {
        (true, _) => "can",
        (false, true) if description.ports.contains_key("tcp") => "tcp",
        (false, _) => "serial",
    };
    let is_such = |port: &PortDescription| matches!(port, PortDescription::Can { .. }) == can;
    let mut roles = description.ports.iter().filter(|(_, port)| is_such(port));
    match description.ports.get(preferred) {
        Some(port) if is_such(port) => Some(preferred),
        _ => roles.next().map(|(role, _)| role.as_str()),
    }
}
