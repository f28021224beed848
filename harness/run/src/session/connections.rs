//! Connections of Modbus TCP that a case opens beside that of the bench.

use fieldproof_link::{Farewell, Framing, Line, PortIndex};

use super::Session;
use crate::serial::Assembler;
use crate::stop::Stop;

impl Session<'_> {
    /// The first port that is Modbus TCP.
    pub(crate) fn tcp_port(&self) -> Option<PortIndex> {
        let mut ports = self.lane.ports().iter();
        ports
            .position(|port| port.line == Line::Stream(Framing::ModbusTcp))
            .map(PortIndex)
    }

    /// Opens a further connection to where `port` leads.
    pub(crate) fn connect(&mut self, port: PortIndex, name: &str) -> Result<(), Stop> {
        let connection = self.lane.connect(port, name)?;
        let now = self.lane.now();
        let place = connection.0;
        let properties = self.lane.ports().get(place);
        let assembler = properties.and_then(|it| Assembler::new(it.line, it.has_bit_times()));
        if place >= self.assemblers.len() {
            self.assemblers.resize_with(place + 1, || None);
            self.last_activity.resize(place + 1, now);
        }
        self.assemblers[place] = assembler;
        self.connections.push((connection, port));
        self.closed.retain(|port| *port != connection);
        self.mark_sent();
        Ok(())
    }

    /// Ends a connection that the case has opened.
    pub(crate) fn disconnect(&mut self, port: PortIndex, how: Farewell) -> Result<(), Stop> {
        self.lane.disconnect(port, how)?;
        self.connections
            .retain(|(connection, _)| *connection != port);
        self.inbox.retain(|received| received.port != port);
        Ok(())
    }

    /// Ends all of them.
    pub(crate) fn disconnect_all(&mut self) -> Result<(), Stop> {
        while let Some((connection, _)) = self.connections.last().copied() {
            self.disconnect(connection, Farewell::Close)?;
        }
        Ok(())
    }

    /// Whether `port` is a connection that the case has opened.
    pub(crate) fn is_connection(&self, port: PortIndex) -> bool {
        self.connections.iter().any(|(it, _)| *it == port)
    }

    /// What stands in the record: of a connection, the port that it leads to.
    pub(super) fn recorded_port(&self, port: PortIndex) -> u8 {
        let led = self.connections.iter().find(|(it, _)| *it == port);
        led.map_or(port, |(_, port)| *port).0 as u8
    }
}
