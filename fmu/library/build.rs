//! How the library is linked.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let is = |key: &str, value: &str| std::env::var(key).is_ok_and(|found| found == value);
    if is("CARGO_CFG_TARGET_OS", "linux") {
        // hosts unload libraries while thread-local destructors of ours may still be due
        println!("cargo:rustc-cdylib-link-arg=-Wl,-z,nodelete");
        // a host that loads several units with RTLD_GLOBAL must not mix their functions
        println!("cargo:rustc-cdylib-link-arg=-Wl,-Bsymbolic");
    }
    if is("CARGO_CFG_TARGET_OS", "linux") || is("CARGO_CFG_TARGET_ENV", "gnu") {
        // units travel; debug information does not help those who receive them
        println!("cargo:rustc-cdylib-link-arg=-Wl,--strip-all");
    }
}
