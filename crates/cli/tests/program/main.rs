//! The program from outside, as a user calls it. One program of tests: each more would be linked with the whole program
//! again, and they take turns, where the tests of one share the cores.
#![allow(clippy::unwrap_used)]

mod bad_input;
mod bench;
mod cases;
mod check;
mod compare;
mod cost;
mod damage;
#[cfg(unix)]
mod disk;
mod export_k;
#[cfg(unix)]
mod faults;
#[cfg(unix)]
mod files;
mod import_contact;
mod manual;
mod mesh_file;
#[cfg(unix)]
mod one_window;
mod own_mu;
mod plot;
mod report;
#[cfg(unix)]
mod resume;
mod slider;
#[cfg(unix)]
mod stopped;
mod summary;
#[cfg(unix)]
mod sweep;
#[cfg(unix)]
mod terminal;
mod view;

#[allow(dead_code)]
#[path = "../../../creepage/tests/planted/planted.rs"]
mod planted;
