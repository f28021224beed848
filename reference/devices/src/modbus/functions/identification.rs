//! 2Bh with MEI type 0Eh: the device identification.

use super::Service;
use crate::modbus::{Departure, Exception, Registers};

const READ_DEVICE_IDENTIFICATION: u8 = 0x0E;
/// Objects up to here are of the category.
const BASIC: u8 = 0x02;
const REGULAR: u8 = 0x7F;
const EXTENDED: u8 = 0xFF;
const ONE_OBJECT: u8 = 4;
/// Extended, as a stream and one by one.
const CONFORMITY: u8 = 0x83;
const MORE_FOLLOWS: u8 = 0xFF;
/// The longest data after the function code.
const LONGEST: usize = 252;
/// MEI type, what was asked, conformity, more follows, next object, number of objects.
const HEAD: usize = 6;

impl<R: Registers> Service<'_, R> {
    /// MEI type, what is read, object; answered by as many objects as there is room for.
    pub(super) fn encapsulated(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let &[READ_DEVICE_IDENTIFICATION, ref request @ ..] = data else {
            return Err(Exception::IllegalFunction);
        };
        let &[code, object] = request else {
            return Err(Exception::IllegalDataValue);
        };
        let last = match code {
            1 => BASIC,
            2 => REGULAR,
            3 | ONE_OBJECT => EXTENDED,
            _ => return Err(Exception::IllegalDataValue),
        };
        let objects = self.registers.identification();
        let known = objects.iter().any(|(id, _)| *id == object && *id <= last);
        if code == ONE_OBJECT {
            let one = objects.iter().find(|(id, _)| *id == object);
            return match one {
                Some(one) => Ok(self.list(code, &[one], None)),
                None if self.behaviour.unknown_object_answered => {
                    Ok(self.list(code, &objects.first().into_iter().collect::<Vec<_>>(), None))
                }
                None => Err(Exception::IllegalDataAddress),
            };
        }
        // A stream that begins with what there is not begins at the beginning.
        let from = if known { object } else { 0 };
        let last = match self.behaviour.categories_ignored {
            true => EXTENDED,
            false => last,
        };
        let mut stream = objects.iter().filter(|(id, _)| (from..=last).contains(id));
        let mut room = LONGEST - HEAD;
        let mut list = Vec::new();
        let mut next = None;
        for object in stream.by_ref() {
            let length = 2 + object.1.len();
            if length > room {
                next = Some(object.0);
                break;
            }
            room -= length;
            list.push(object);
        }
        Ok(self.list(code, &list, next))
    }

    fn list(&self, code: u8, objects: &[&(u8, &str)], next: Option<u8>) -> Vec<u8> {
        let next = next.filter(|_| !self.behaviour.more_follows_missing);
        let number = u8::try_from(objects.len()).unwrap_or(u8::MAX);
        let mut answer = vec![
            READ_DEVICE_IDENTIFICATION,
            code,
            CONFORMITY,
            next.map_or(0, |_| MORE_FOLLOWS),
            match self.behaviour.departs(Departure::NextObjectWrong) {
                true => next.map_or(0, |next| next.wrapping_add(1)),
                false => next.unwrap_or(0),
            },
            number,
        ];
        for (id, text) in objects {
            answer.extend([*id, u8::try_from(text.len()).unwrap_or(u8::MAX)]);
            answer.extend(text.bytes());
        }
        answer
    }
}
