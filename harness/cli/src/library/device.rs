//! A device with everything that is known of it, and where it stands.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use fieldproof_devices::{DeviceKind, Fault, Variant};
use fieldproof_dictionary::Dictionary;
use fieldproof_dictionary::registers::RegisterMap;
use fieldproof_record::UsedFile;
use fieldproof_run::{Known, fill, fill_some, suites_for};
use fieldproof_suite::bench::{Link, LinkKind};
use fieldproof_suite::device::{DeviceDescription, Feature};
use fieldproof_suite::model::{Effect, Located, StimulusName};
use fieldproof_suite::{Position, Suite};

/// Index and sub-index.
const SERIAL_NUMBER: (u16, u8) = (0x1018, 4);

/// A device with everything that is known of it.
#[derive(Clone)]
pub struct Device {
    /// What it claims.
    pub description: DeviceDescription,
    /// Its object dictionary, if it has a CANopen side.
    pub dictionary: Option<Dictionary>,
    /// Its register map, if it has a Modbus side of which that is known.
    pub registers: Option<RegisterMap>,
    /// The bit rates that its EDS claims.
    pub bit_rates_kbit_per_s: BTreeSet<u32>,
    /// The reference device of that name; without one, the device cannot be simulated.
    pub kind: Option<&'static DeviceKind>,
    /// The files it is described in.
    pub files: Vec<UsedFile>,
    /// Where a bench has it.
    pub place: Option<Place>,
    /// The suites it is tested with, of those that are asked for, filled from its dictionary.
    pub suites: Vec<Suite>,
}

/// What a bench says of a device.
#[derive(Debug, Clone)]
pub struct Place {
    /// What the bench calls it.
    pub name: String,
    /// What the ports that are connected are connected to, by role.
    pub links: BTreeMap<String, Link>,
    /// The stimuli there are; those that the links offer if nothing is said.
    pub stimuli: Option<BTreeSet<StimulusName>>,
    /// What gives them on real links; without it, an operator is asked.
    pub stimulus_command: Option<Vec<String>>,
    /// What is permitted.
    pub permits: BTreeSet<Effect>,
}

impl Device {
    /// Whether it is a reference device on simulated links, and not a real one.
    pub fn is_simulated(&self) -> bool {
        let links = self.place.as_ref().map(|place| &place.links);
        links.is_none_or(|links| links.values().all(|link| link.kind == LinkKind::Sim))
    }

    /// What is claimed of the unit that is tested: the serial number of a simulated one is that of its EDS.
    pub(crate) fn description_of_unit(&self) -> Cow<'_, DeviceDescription> {
        let serial_number = self.dictionary.as_ref().and_then(|dictionary| {
            let entry = dictionary.entry(SERIAL_NUMBER.0, SERIAL_NUMBER.1)?;
            let bytes = entry.default_bytes(0)?.try_into().ok()?;
            Some(u32::from_le_bytes(bytes))
        });
        if !self.is_simulated() || self.description.identity.serial_number.is_some() {
            return Cow::Borrowed(&self.description);
        }
        let mut description = self.description.clone();
        description.identity.serial_number = serial_number.map(|value| Located {
            value,
            at: Position::default(),
        });
        Cow::Owned(description)
    }

    /// The faults its reference device can have; nothing can be switched on in a real device.
    pub fn faults(&self) -> impl Iterator<Item = &'static Fault> + use<> {
        self.simulated().into_iter().flat_map(DeviceKind::faults)
    }

    /// The legal variants of its reference device; a real one is what it is.
    pub fn variants(&self) -> &'static [Variant] {
        self.simulated().map_or(&[], |kind| kind.variants)
    }

    /// The device with at most `most` rows of every table that its dictionary or register map fills.
    pub(crate) fn with_some_of_each(&self, suites: &[Suite], most: u16) -> Device {
        let known = self.known();
        let some = |suite| fill_some(suite, &self.description, known, most);
        Device {
            suites: suites_for(suites, &self.description).map(some).collect(),
            ..self.clone()
        }
    }

    /// The same with other numbers on its lines.
    pub(crate) fn numbered(&self, node: u8, address: u8) -> Device {
        let mut device = self.clone();
        if let Some(canopen) = &mut device.description.canopen {
            canopen.node = node;
        }
        if let Some(modbus) = &mut device.description.modbus {
            modbus.address = address;
        }
        device
    }

    /// One that was configured: its defaults hold no more.
    pub(crate) fn configured(&self) -> Device {
        let mut device = self.clone();
        let features = &mut device.description.features;
        features.retain(|feature| *feature != Feature::FactorySettings);
        device
    }

    /// Fills the suites that it is tested with.
    pub(super) fn fill(&mut self, suites: &[Suite]) {
        let known = self.known();
        self.suites = suites_for(suites, &self.description)
            .map(|suite| fill(suite, &self.description, known))
            .collect();
    }

    fn known(&self) -> Known<'_> {
        Known {
            dictionary: self.dictionary.as_ref(),
            registers: self.registers.as_ref(),
            bit_rates_kbit_per_s: Some(&self.bit_rates_kbit_per_s),
        }
    }

    fn simulated(&self) -> Option<&'static DeviceKind> {
        self.kind.filter(|_| self.is_simulated())
    }

    /// Its name on the bench, or else that of its description.
    pub fn name(&self) -> &str {
        match &self.place {
            Some(place) => &place.name,
            None => &self.description.device,
        }
    }
}
