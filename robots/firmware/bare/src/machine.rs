//! Interface to the machine: the entry point, the functions that rustc expects on every platform, and two system calls
//! in place of a serial port and a reset.
#![allow(unsafe_code, reason = "the machine is reached by instructions, and the linker finds functions by their names")]

use core::{
    arch::{asm, naked_asm},
    panic::PanicInfo,
};

const WRITE: usize = 1;
const EXIT: usize = 60;
const STANDARD_OUTPUT: usize = 1;
/// Exit code of a program that panicked, as with the standard library.
const PANICKED: usize = 101;

/// Entry point of the program. Aligns the stack as a called function expects it.
// SAFETY: without a C library, nothing else has this name.
#[unsafe(no_mangle)]
#[unsafe(naked)]
extern "C" fn _start() -> ! {
    naked_asm!("xor ebp, ebp", "call {main}", "ud2", main = sym crate::main)
}

#[panic_handler]
fn panicked(_info: &PanicInfo<'_>) -> ! {
    write(b"panicked\n");
    exit(PANICKED)
}

/// Writes to standard output, as much as the kernel takes.
pub fn write(text: &[u8]) {
    // SAFETY: the kernel reads `text.len()` valid bytes, and changes nothing but these registers.
    unsafe {
        asm!(
            "syscall",
            inlateout("rax") WRITE => _,
            in("rdi") STANDARD_OUTPUT,
            in("rsi") text.as_ptr(),
            in("rdx") text.len(),
            lateout("rcx") _,
            lateout("r11") _,
            options(nostack, readonly),
        );
    }
}

/// Ends the program.
pub fn exit(code: usize) -> ! {
    // SAFETY: the system call does not return.
    unsafe { asm!("syscall", in("rax") EXIT, in("rdi") code, options(nostack, noreturn)) }
}

/// Copies bytes with an instruction, as rustc would turn a loop into a recursive call of this function.
// SAFETY: behaves as the C standard specifies for this name.
#[unsafe(no_mangle)]
unsafe extern "C" fn memcpy(to: *mut u8, from: *const u8, count: usize) -> *mut u8 {
    // SAFETY: the caller guarantees that both ranges are valid.
    unsafe {
        asm!(
            "rep movsb",
            inout("rcx") count => _,
            inout("rdi") to => _,
            inout("rsi") from => _,
            options(nostack, preserves_flags),
        );
    }
    to
}

/// Sets bytes.
// SAFETY: behaves as the C standard specifies for this name.
#[unsafe(no_mangle)]
unsafe extern "C" fn memset(to: *mut u8, byte: i32, count: usize) -> *mut u8 {
    // SAFETY: the caller guarantees that the range is valid.
    unsafe {
        asm!(
            "rep stosb",
            inout("rcx") count => _,
            inout("rdi") to => _,
            in("al") byte as u8,
            options(nostack, preserves_flags),
        );
    }
    to
}
