//! Internal force of a block of hexahedra, one-point and fully integrated; items are elements.

use divan::counter::ItemsCount;
use mesh::Padded;
use solid::{Element, Elements, Level, Material, Solid, Viscosity, Volumetric};

fn main() {
    divan::main();
}

const LEVELS: [Level; 4] = [Level::Avx512, Level::Avx2, Level::Neon, Level::Portable];
const ONE_POINT: Element = Element { hourglass: 0.05 };

fn run<'a>(
    bencher: divan::Bencher,
    elements: impl Into<Elements<'a>>,
    n: usize,
    level: Level,
    threads: usize,
    energies: bool,
) {
    if !level.available() {
        return;
    }
    let size = n as f64 * 1e-3;
    let mesh = mesh::block([n, n, n], [size, size, size]);
    let steel = Material { young: 210e9, poisson: 0.3, density: 7850.0 };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let mut solid = Solid::new(&mesh, &[steel], elements, Viscosity::default(), level)
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
    run(bencher, ONE_POINT, 48, level, 1, false);
}

#[divan::bench(args = LEVELS)]
fn two_threads_110k(bencher: divan::Bencher, level: Level) {
    run(bencher, ONE_POINT, 48, level, 2, false);
}

#[divan::bench(args = LEVELS)]
fn one_thread_110k_with_energies(bencher: divan::Bencher, level: Level) {
    run(bencher, ONE_POINT, 48, level, 1, true);
}

#[divan::bench(args = LEVELS)]
fn one_thread_885k(bencher: divan::Bencher, level: Level) {
    run(bencher, ONE_POINT, 96, level, 1, false);
}

#[divan::bench(args = LEVELS)]
fn full_one_thread_110k(bencher: divan::Bencher, level: Level) {
    run(bencher, Volumetric::Full, 48, level, 1, false);
}

#[divan::bench(args = LEVELS)]
fn full_two_threads_110k(bencher: divan::Bencher, level: Level) {
    run(bencher, Volumetric::Full, 48, level, 2, false);
}

#[divan::bench(args = LEVELS)]
fn mean_dilatation_one_thread_110k(bencher: divan::Bencher, level: Level) {
    run(bencher, Volumetric::Mean, 48, level, 1, false);
}

#[divan::bench(args = LEVELS)]
fn mean_dilatation_two_threads_110k(bencher: divan::Bencher, level: Level) {
    run(bencher, Volumetric::Mean, 48, level, 2, false);
}
