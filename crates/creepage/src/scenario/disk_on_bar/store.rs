//! Preloads kept for the runs that share them.
//!
//! A preload depends on part of a case only. Friction and the drive have no effect on it, save the speed, which
//! gives the centrifugal force; damping and the tangential springs only by dynamic relaxation, the time step only by
//! springs that are a fraction of the stability limit. It is kept under the SHA-256 of that part, in
//! `HASH.preload` of a folder that any number of runs may use at once:
//!
//! | bytes | what |
//! |---|---|
//! | a line | `creepage preload 1` |
//! | a line | JSON: `hash`, `nodes`, `report`, `loads` |
//! | 24 per node | displacement x, y, z (m), little-endian doubles |
//! | 32 | SHA-256 of all before |
//!
//! A file is written under another name and renamed, so that nobody reads an incomplete one; one whose checksum
//! does not match is not used. `HASH.lock` is locked while a run computes or reads its preload: of runs that start
//! together one computes it, and the others wait for it.

use std::fs::{self, File, TryLockError};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use mesh::Padded;
use output::files::input;
use output::hexadecimal;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::preload::Preloaded;
use crate::case::schema::{Case, PreloadMethod, Stiffness};
use crate::scenario::error::ScenarioError;
use crate::scenario::model::Model;
use crate::scenario::preload::PreloadReport;
use output::NotWritten;

/// The method of the preload: another number where the same case would be given other bits.
const METHOD: u32 = 2;
const MAGIC: &str = "creepage preload 1";
const CHECKSUM: usize = 32;
/// How often a run that waits for another's preload tries the lock.
const LOOK: Duration = Duration::from_millis(50);

type Say<'a> = dyn FnMut(&str) -> Result<(), NotWritten> + Send + 'a;

#[derive(Serialize, Deserialize)]
struct Header {
    hash: String,
    nodes: usize,
    report: PreloadReport,
    loads: [Vec<(u32, f64)>; 2],
}

/// SHA-256, in hexadecimal, of everything that a preload's bits depend on: the program's version,
/// the method, its kernels, and the keys that reach the preload.
pub(crate) fn key(case: &Case, kernels: &str) -> String {
    let penalty = &case.contact.penalty;
    let relaxation = case.preload.method == PreloadMethod::Relaxation;
    let by_step = |s: Stiffness| matches!(s, Stiffness::Stability(_));
    let steps = by_step(penalty.normal) || relaxation && by_step(penalty.tangential);
    // as a tuple, since text that nobody reads needs no names
    let basis = (
        (env!("CARGO_PKG_VERSION"), METHOD, kernels),
        (&case.disk, &case.bar, &case.material, &case.mesh, &case.element),
        // the speed for the centrifugal force
        (case.load.normal, case.load.hub_mass, case.drive.speed),
        (case.contact.enforcement, case.contact.rows, case.contact.curvature, case.contact.normals),
        (penalty.normal, case.preload.undisturbed()),
        // relaxation takes its fictitious masses from both springs
        relaxation.then_some((penalty, &case.damping)),
        // springs that are a fraction of the stability limit follow the step
        steps.then_some((case.time.factor, case.time.step)),
    );
    let basis = serde_json::to_string(&basis).unwrap_or_default();
    hexadecimal(&Sha256::digest(basis))
}

/// The preload of `case` from `folder`, or else by `find`; that one is then kept in `folder` for others.
pub(crate) fn kept(
    case: &Case,
    model: &Model,
    folder: Option<&Path>,
    stop: &AtomicBool,
    say: &mut Say<'_>,
    find: &mut dyn FnMut(&mut Say<'_>) -> Result<Preloaded, ScenarioError>,
) -> Result<Preloaded, ScenarioError> {
    let Some(folder) = folder.filter(|_| case.preload.method != PreloadMethod::None) else {
        return find(say);
    };
    let key = key(case, model.kernels.name());
    let path = folder.join(format!("{key}.preload"));
    let unwritable = |cause| NotWritten { path: folder.to_path_buf(), cause };
    fs::create_dir_all(folder).map_err(unwritable)?;
    // Held to the end of this function; a system without locks costs a second computation at most.
    let _lock = lock(&folder.join(format!("{key}.lock")), stop);
    match read(&path, &key, model.mesh.nodes.len()) {
        Ok(Some(preloaded)) => {
            say(&format!("preload: taken from {}", path.display()))?;
            return Ok(preloaded);
        }
        Ok(None) => {}
        Err(damage) => {
            say(&format!("preload: {} is not used, found anew: {damage}", path.display()))?;
        }
    }
    let found = find(say)?;
    if let Some(report) = found.report {
        let loads = found.loads.clone();
        let header = Header { hash: key, nodes: found.displacement.len(), report, loads };
        // A cache that cannot be written makes runs slower, not wrong.
        if let Err(cause) = write(&path, &header, &found.displacement) {
            say(&format!("preload: not kept in {}: {cause}", path.display()))?;
        }
    }
    Ok(found)
}

fn lock(path: &Path, stop: &AtomicBool) -> Option<File> {
    let file = File::create(path).ok()?;
    loop {
        match file.try_lock() {
            Ok(()) => return Some(file),
            Err(TryLockError::WouldBlock) if !stop.load(Ordering::Relaxed) => {
                std::thread::sleep(LOOK);
            }
            Err(_) => return None,
        }
    }
}

/// The preload in a file, if there is one; as the error, why the file cannot be used.
fn read(path: &Path, key: &str, nodes: usize) -> Result<Option<Preloaded>, String> {
    let bytes = match input::bytes(path, input::PRELOAD) {
        Ok(bytes) => bytes,
        Err(error) if error.is_missing() => return Ok(None),
        Err(error) => return Err(error.problem()),
    };
    let (content, checksum) =
        bytes.split_last_chunk::<CHECKSUM>().ok_or("it is cut off before its checksum")?;
    if Sha256::digest(content)[..] != checksum[..] {
        return Err("its checksum does not match".into());
    }
    let mut parts = content.splitn(3, |&byte| byte == b'\n');
    let (magic, header) = (parts.next(), parts.next());
    let numbers = parts.next().ok_or("its header is cut off")?;
    if magic != Some(MAGIC.as_bytes()) {
        return Err(format!("it does not begin with `{MAGIC}`"));
    }
    let header: Header =
        serde_json::from_slice(header.unwrap_or_default()).map_err(|error| error.to_string())?;
    if header.hash != key || header.nodes != nodes || numbers.len() != 24 * nodes {
        return Err("it is the preload of another case".into());
    }
    let (numbers, _) = numbers.as_chunks::<8>();
    let (points, _) = numbers.as_chunks::<3>();
    let displacement =
        points.iter().map(|point| Padded::new(point.map(f64::from_le_bytes))).collect();
    Ok(Some(Preloaded { displacement, report: Some(header.report), loads: header.loads }))
}

fn write(path: &Path, header: &Header, displacement: &[Padded]) -> std::io::Result<()> {
    let mut content = format!("{MAGIC}\n{}\n", serde_json::to_string(header)?).into_bytes();
    for u in displacement {
        u.xyz().iter().for_each(|x| content.extend(x.to_le_bytes()));
    }
    let checksum = Sha256::digest(&content);
    let partial: PathBuf = path.with_extension(format!("{}.partial", std::process::id()));
    let result = (|| {
        let mut file = BufWriter::new(File::create(&partial)?);
        file.write_all(&content)?;
        file.write_all(&checksum)?;
        file.into_inner()?.sync_all()?;
        fs::rename(&partial, path)
    })();
    if result.is_err() {
        // The incomplete file is of no use; the error that matters is the first.
        let _ = fs::remove_file(&partial);
    }
    result
}
