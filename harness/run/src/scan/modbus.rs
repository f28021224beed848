//! Which Modbus servers there are.

use std::time::Duration;

use fieldproof_link::{Lane, LinkError, PortIndex};
use fieldproof_wire::modbus::pdu::{ReadDeviceId, ReadQuantity};
use fieldproof_wire::modbus::{ExceptionCode, Request, Response};

use super::exchange::{Exchange, Outcome};

/// Servers that say of themselves that more follows are believed this often.
const MOST_PARTS: usize = 8;

/// On Modbus TCP: what a server that is alone at its connection answers to. Who answers all of them answers every unit.
const UNITS_OF_ONE_SERVER: [u8; 3] = [1, 255, 0];

/// How servers are looked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ModbusScan {
    /// The addresses that are asked, in this order; on Modbus TCP, the units. All that there are, if none is given.
    pub addresses: Vec<u8>,
    /// How long a server may take to begin its answer.
    pub timeout: Duration,
}

/// What was found.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ModbusFound {
    /// In the order they were asked.
    pub servers: Vec<FoundServer>,
    /// Addresses at which something came that was no answer: servers that are set otherwise, or two with one address.
    pub noise: Vec<u8>,
    /// Whether it is a single server at a connection that answers whatever the unit is.
    pub every_unit: bool,
}

/// A server that answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FoundServer {
    /// Its address, or unit.
    pub address: u8,
    /// What it said to reading holding register 0: the value, or the exception.
    pub register_0: Result<u16, ExceptionCode>,
    /// Its device identification: number and text of each object (00h vendor name, 01h product code, 02h revision).
    /// Empty if it has none.
    pub identification: Vec<(u8, String)>,
    /// What function 11h reports, as text, if it has that and no device identification.
    pub server_id: Option<String>,
}

/// Asks one address after the other on `port`. Holding register 0 is read, for silence to functions that it does not
/// know is what some devices have; only those that answer are asked for their identification. Nothing is written.
///
/// # Errors
/// [`LinkError`]: the link failed. A port that carries no characters has no servers.
pub fn scan_modbus(
    lane: &mut dyn Lane,
    port: PortIndex,
    how: &ModbusScan,
    mut progress: impl FnMut(),
) -> Result<ModbusFound, LinkError> {
    let mut found = ModbusFound::default();
    let Some(mut exchange) = Exchange::new(lane, port, how.timeout) else {
        return Ok(found);
    };
    let all = how.addresses.is_empty();
    let addresses = match all {
        true => every_address(exchange.is_modbus_tcp()),
        false => how.addresses.clone(),
    };
    let asked = addresses.len();
    for address in addresses {
        if let Some(server) = look(&mut exchange, address, &mut found.noise)? {
            found.servers.push(server);
        }
        progress();
        let answered = found.servers.iter().map(|server| server.address);
        if all && answered.eq(UNITS_OF_ONE_SERVER) {
            found.every_unit = true;
            found.servers.truncate(1);
            break;
        }
    }
    if !all && asked > 1 && found.servers.len() == asked && is_one_server(&mut exchange, &found)? {
        found.every_unit = true;
        found.servers.truncate(1);
    }
    Ok(found)
}

/// Whether what answered everywhere is a single server at a connection: all say the same of themselves, and the units that
/// nobody else has answer, too.
fn is_one_server(exchange: &mut Exchange<'_>, found: &ModbusFound) -> Result<bool, LinkError> {
    let Some(first) = found.servers.first() else {
        return Ok(false);
    };
    let is_like = |other: &FoundServer| {
        let other = FoundServer {
            address: first.address,
            ..other.clone()
        };
        other == *first
    };
    if !exchange.is_modbus_tcp() || !found.servers.iter().all(is_like) {
        return Ok(false);
    }
    for unit in UNITS_OF_ONE_SERVER {
        match look(exchange, unit, &mut Vec::new())? {
            Some(server) if is_like(&server) => {}
            _ => return Ok(false),
        }
    }
    Ok(true)
}

/// How many addresses [`scan_modbus`] asks at most if none is given.
pub const MOST_ADDRESSES: usize = 249;

fn every_address(units: bool) -> Vec<u8> {
    match units {
        true => UNITS_OF_ONE_SERVER.into_iter().chain(2..=247).collect(),
        false => (1..=247).collect(),
    }
}

/// The server at `address`, if there is one.
fn look(
    exchange: &mut Exchange<'_>,
    address: u8,
    noise: &mut Vec<u8>,
) -> Result<Option<FoundServer>, LinkError> {
    let Some(quantity) = ReadQuantity::new(1) else {
        return Ok(None);
    };
    let request = Request::ReadHoldingRegisters { start: 0, quantity };
    let register_0 = match exchange.ask(address, &request.encode())? {
        Outcome::Silence => return Ok(None),
        Outcome::Noise(_) => {
            noise.push(address);
            return Ok(None);
        }
        Outcome::Answer(pdu) => match Response::parse(&pdu) {
            Ok(Response::ReadHoldingRegisters(values)) => match values.first() {
                Some(value) => Ok(*value),
                None => return Ok(None),
            },
            Ok(Response::Exception { code, .. }) => Err(code),
            _ => {
                noise.push(address);
                return Ok(None);
            }
        },
    };
    // Said by a gateway, of somebody who is not there.
    if let Err(
        ExceptionCode::GatewayPathUnavailable | ExceptionCode::GatewayTargetDeviceFailedToRespond,
    ) = register_0
    {
        return Ok(None);
    }
    let identification = identification(exchange, address)?;
    let server_id = match identification.is_empty() {
        true => server_id(exchange, address)?,
        false => None,
    };
    Ok(Some(FoundServer {
        address,
        register_0,
        identification,
        server_id,
    }))
}

fn identification(
    exchange: &mut Exchange<'_>,
    address: u8,
) -> Result<Vec<(u8, String)>, LinkError> {
    let mut objects = Vec::new();
    let mut object = 0;
    for _ in 0..MOST_PARTS {
        let request = Request::ReadDeviceIdentification {
            read: ReadDeviceId::Basic,
            object,
        };
        let Outcome::Answer(pdu) = exchange.ask(address, &request.encode())? else {
            break;
        };
        let Ok(Response::ReadDeviceIdentification(part)) = Response::parse(&pdu) else {
            break;
        };
        objects.extend(part.objects.iter().map(|it| (it.id, text(&it.value))));
        match part.next {
            Some(next) => object = next,
            None => break,
        }
    }
    Ok(objects)
}

fn server_id(exchange: &mut Exchange<'_>, address: u8) -> Result<Option<String>, LinkError> {
    let answer = exchange.ask(address, &Request::ReportServerId.encode())?;
    let Outcome::Answer(pdu) = answer else {
        return Ok(None);
    };
    Ok(match Response::parse(&pdu) {
        Ok(Response::ReportServerId(bytes)) => Some(text(&bytes)),
        _ => None,
    })
}

/// What can be read of it; a dot for anything else.
fn text(bytes: &[u8]) -> String {
    let shown = |byte: &u8| match byte {
        b' '..=b'~' => char::from(*byte),
        _ => '.',
    };
    bytes.iter().map(shown).collect()
}
