//! Output to the debugger, or to QEMU in its place.

use core::panic::PanicInfo;
use cortex_m_semihosting::{debug, hio};

/// Shows a text.
pub fn write(text: &[u8]) {
    // Fails without a debugger, which does not matter.
    let _ = hio::hstdout().and_then(|mut output| output.write_all(text));
}

/// Ends the run.
pub fn exit(result: debug::ExitStatus) -> ! {
    debug::exit(result);
    // A debugger may continue the program.
    loop {
        cortex_m::asm::bkpt();
    }
}

#[panic_handler]
fn panicked(_info: &PanicInfo<'_>) -> ! {
    write(b"panicked\n");
    exit(debug::EXIT_FAILURE)
}
