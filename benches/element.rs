//! Internal force of a block of hexahedra; items are elements.

use divan::counter::ItemsCount;
use mesh::Padded;
use solid::{Element, Level, Material, Solid, Viscosity};

fn main() {
    divan::main();
}

const LEVELS: [Level; 3] = [Level::Avx512, Level::Avx2, Level::Portable];

fn run(bencher: divan::Bencher, n: usize, level: Level, threads: usize, energies: bool) {
    if !level.available() {
        return;
    }
    let size = n as f64 * 1e-3;
    let mesh = mesh::block([n, n, n], [size, size, size]);
    let steel = Material { young: 210e9, poisson: 0.3, density: 7850.0 };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let mut solid =
        Solid::new(&mesh, &[steel], Element { hourglass: 0.05 }, Viscosity::default(), level)
            .expect("a block of steel");
    let u: Vec<_> =
        mesh.nodes.iter().map(|p| Padded::new([1e-4 * p[1], 1e-4 * p[2], 1e-4 * p[0]])).collect();
    let mut f = vec![Padded::ZERO; u.len()];
    bencher
        .counter(ItemsCount::new(mesh.hexes.len()))
        .bench_local(|| pool.install(|| solid.subtract_internal_force(&u, &u, &mut f, energies)));
}

#[divan::bench(args = LEVELS)]
fn one_thread_110k(bencher: divan::Bencher, level: Level) {
    run(bencher, 48, level, 1, false);
}

#[divan::bench(args = LEVELS)]
fn two_threads_110k(bencher: divan::Bencher, level: Level) {
    run(bencher, 48, level, 2, false);
}

#[divan::bench(args = LEVELS)]
fn one_thread_110k_with_energies(bencher: divan::Bencher, level: Level) {
    run(bencher, 48, level, 1, true);
}

#[divan::bench(args = LEVELS)]
fn one_thread_885k(bencher: divan::Bencher, level: Level) {
    run(bencher, 96, level, 1, false);
}
