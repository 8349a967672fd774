//! The 1-D slider: five million steps (5 s at 1 us) of each method, and the paper's tables. Items
//! are steps.
#![allow(missing_docs)]

use divan::counter::ItemsCount;
use slider::{Method, Parameters, run, tables, unobserved};

fn main() {
    divan::main();
}

#[divan::bench(args = Method::ALL, sample_count = 5)]
fn five_million_steps(bencher: divan::Bencher, method: &Method) {
    let p = Parameters { dt: 1e-6, ..Parameters::default() };
    bencher
        .counter(ItemsCount::new(5_000_000u64))
        .bench(|| run(divan::black_box(&p), *method, unobserved).expect("a stable run"));
}

#[divan::bench(sample_count = 5)]
fn all_tables() -> tables::Tables {
    tables::tables().expect("stable runs")
}
