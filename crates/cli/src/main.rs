//! Creepage.
fn main() {}
