#![no_main]
//! libFuzzer on the target of this name.

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    recon_fuzz::target("planar_contacts").map(|target| (target.run)(bytes));
});
