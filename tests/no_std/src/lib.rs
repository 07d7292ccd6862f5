//! A controller's library without `std`: the declaration and the run are in `sled`, the rest is what a machine
//! without operating system has to bring along.
#![no_std]

mod sled;

/// The heading of the sled after `seconds`.
#[unsafe(no_mangle)]
pub extern "C" fn heading(seconds: f64) -> f64 {
    sled::heading(seconds)
}

/// Only where panics abort: elsewhere `std` brings its own. A second one would be an error, so nothing here needs `std`.
#[cfg(panic = "abort")]
#[panic_handler]
fn halt(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
