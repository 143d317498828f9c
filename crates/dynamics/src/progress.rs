//! Long work that asks, as it goes, whether to go on.

use core::ops::ControlFlow;

use crate::error::Stopped;

/// Asked every few milliseconds of one long piece of work whether to go on; once it says no it is not
/// asked again.
pub type Cancel<'a> = &'a dyn Fn() -> ControlFlow<()>;

/// Asks whether to go on after so much work.
pub(crate) struct Pulse<'a> {
    go_on: Cancel<'a>,
    /// Units of work until it asks again.
    left: u32,
    stopped: bool,
}

/// Work that nothing stops.
pub const NEVER_CANCELLED: Cancel<'static> = &|| ControlFlow::Continue(());

impl<'a> Pulse<'a> {
    /// Units of work between two questions; a unit is some ten nanoseconds.
    const UNITS: u32 = 1 << 18;

    /// Asks for the first time with the first work.
    pub(crate) fn new(go_on: Cancel<'a>) -> Self {
        Self { go_on, left: 0, stopped: false }
    }

    /// So many units are done.
    #[inline(always)]
    pub(crate) fn tick(&mut self, units: u32) -> Result<(), Stopped> {
        if units < self.left {
            self.left -= units;
            return Ok(());
        }
        self.ask()
    }

    #[cold]
    fn ask(&mut self) -> Result<(), Stopped> {
        self.stopped = self.stopped || (self.go_on)().is_break();
        if self.stopped {
            self.left = 0;
            return Err(Stopped);
        }
        self.left = Self::UNITS;
        Ok(())
    }
}
