//! The floating-point environment: the host's outside, the standard one inside.
//!
//! Rounding to nearest, no trap, no flushing of subnormal numbers: compiled code takes this for granted, and the same
//! bits everywhere depend on it. Hosts set other environments (directed rounding, trapping exceptions, flush to zero).
//! Threads that are started inside inherit the standard one.

/// Does something in the standard environment, and gives the host its own back, panic or not.
pub(crate) fn standard<T>(action: impl FnOnce() -> T) -> T {
    let _host = Host::leave();
    action()
}

/// The host's environment, which comes back when this is dropped.
struct Host {
    /// Control and status of the SSE unit (MXCSR).
    #[cfg(target_arch = "x86_64")]
    control: u32,
}

/// MXCSR with all exceptions masked, round to nearest, subnormal numbers kept, no flag raised.
#[cfg(target_arch = "x86_64")]
const STANDARD: u32 = 0x1F80;

/// Brings a value into MXCSR.
#[cfg(target_arch = "x86_64")]
#[inline(never)]
fn set(control: u32) {
    // SAFETY: the value came from the register or has no reserved bit set; it is read from where it stands.
    unsafe { std::arch::asm!("ldmxcsr [{}]", in(reg) &raw const control, options(nostack, readonly)) };
}

/// The value of MXCSR.
#[cfg(target_arch = "x86_64")]
#[inline(never)]
fn get() -> u32 {
    let mut control = 0_u32;
    // SAFETY: four bytes are written to where four bytes stand.
    unsafe { std::arch::asm!("stmxcsr [{}]", in(reg) &raw mut control, options(nostack)) };
    control
}

#[cfg(target_arch = "x86_64")]
impl Host {
    /// Leaves the host's environment for the standard one.
    fn leave() -> Self {
        let control = get();
        set(STANDARD);
        Self { control }
    }
}

#[cfg(target_arch = "x86_64")]
impl Drop for Host {
    fn drop(&mut self) {
        set(self.control);
    }
}

#[cfg(not(target_arch = "x86_64"))]
impl Host {
    /// On other processors the host's environment is taken as it is.
    fn leave() -> Self {
        Self {}
    }
}

#[cfg(all(test, target_arch = "x86_64"))]
pub(crate) mod trial {
    /// Does something in another environment, as a host might.
    pub(crate) fn within<T>(control: u32, action: impl FnOnce() -> T) -> T {
        let own = super::get();
        super::set(control);
        let result = action();
        let left = super::get();
        super::set(own);
        assert_eq!(left & !0x3F, control & !0x3F, "the environment of the host came back");
        result
    }
}
