//! Compiles the guardian, a program of its own, which the library carries within it.

use std::env;
use std::ffi::OsString;
use std::path::Path;
use std::process::Command;

const SOURCE: &str = "src/guardian/program.rs";
/// Its part for each system.
const PARTS: &str = "src/guardian/program";
/// What makes it small.
const SMALL: &[&str] = &["-Cpanic=abort", "-Clto=fat"];

fn main() {
    println!("cargo:rerun-if-changed={SOURCE}");
    println!("cargo:rerun-if-changed={PARTS}");
    println!("cargo:rerun-if-changed=build.rs");
    let of = |name: &str| env::var_os(name).unwrap_or_default();
    let program = Path::new(&of("OUT_DIR")).join("guardian.program");
    // A standard library that was compiled here may lack what the small one takes.
    let is_made = [SMALL, &[]].iter().any(|options| {
        let mut rustc = Command::new(of("RUSTC"));
        rustc.args([
            "--edition=2024",
            "--crate-name=guardian",
            "--crate-type=bin",
        ]);
        rustc
            .args(["-Copt-level=s", "-Cstrip=symbols"])
            .args(*options);
        rustc.arg("--target").arg(of("TARGET"));
        if let Some(linker) = env::var_os("RUSTC_LINKER") {
            let mut option = OsString::from("-Clinker=");
            option.push(linker);
            rustc.arg(option);
        }
        rustc.arg("-o").arg(&program).arg(SOURCE);
        rustc.status().is_ok_and(|status| status.success())
    });
    // A check for another system has no linker for it, and makes nothing that runs.
    let is_for_here = of("HOST") == of("TARGET");
    assert!(is_made || !is_for_here, "{SOURCE} does not compile");
    if !is_made {
        println!("cargo:warning=without a guardian: {SOURCE} was not linked");
        std::fs::write(&program, []).expect("the build's folder can be written to");
    }
}
