//! What drives a craft, as channels: which of them a recording must have, and in which order a simulation takes those of named actuators.
//! What an actuator does with its channels is defined by its term.

use super::channel::Channel;
use crate::ship::Ship;
use serde::Serialize;

/// The channels that drive a craft.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Driven {
    /// Whether there is the propeller of the channel `n`.
    pub propeller: bool,
    /// Whether there is the rudder of the channel `delta`.
    pub rudder: bool,
    /// The channels of the named actuators, in the order of [`Inputs::commands`](crate::Inputs::commands).
    pub commands: Vec<Channel>,
}

impl Default for Driven {
    /// A ship with one propeller and one rudder.
    fn default() -> Self {
        Self { propeller: true, rudder: true, commands: Vec::new() }
    }
}

impl Driven {
    /// What drives this craft.
    pub fn of(ship: &Ship) -> Self {
        let commands = ship.commands().iter().filter_map(|name| Channel::from_name(name)).collect();
        Self { propeller: ship.has_propeller(), rudder: ship.has_rudder(), commands }
    }

    /// The channels that every recording of the craft must have.
    pub fn needs(&self) -> impl Iterator<Item = Channel> + '_ {
        let shaft = self.propeller.then_some(Channel::N);
        let helm = self.rudder.then_some(Channel::Delta);
        shaft.into_iter().chain(helm).chain(self.commands.iter().copied())
    }

    /// The channels of those that are not there, nor what was ordered in their place.
    pub fn missing<'a>(&'a self, has: impl Fn(Channel) -> bool + 'a) -> impl Iterator<Item = Channel> + 'a {
        self.needs().filter(move |c| !has(*c) && !c.ordered().is_some_and(&has))
    }
}
