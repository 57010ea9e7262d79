//! Prints the digest of this machine.
fn main() {
    println!("{:032x}", etendue_wasm_check::digest());
}
