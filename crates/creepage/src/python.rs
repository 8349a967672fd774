//! The Python that has the package `creepage`, which draws by PyVista and reads meshes by meshio.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// The interpreter of this process, if it is one.
static OWN: OnceLock<PathBuf> = OnceLock::new();

/// Tells in which interpreter this library runs: it has the package, also where the path leads to another.
pub fn runs_in(interpreter: PathBuf) {
    OWN.get_or_init(|| interpreter);
}

/// Starts the interpreter of this process, or the first Python on the path that has the package; `None` where there is
/// none. No module of the working folder is taken for one of the package.
pub fn with_package() -> Option<Command> {
    let on_path =
        || ["python3", "python"].map(PathBuf::from).into_iter().find(|python| has_package(python));
    OWN.get().cloned().or_else(on_path).map(|python| command(&python))
}

fn has_package(python: &Path) -> bool {
    let mut ask = command(python);
    ask.args(["-c", "import creepage"]).stdin(Stdio::null());
    ask.stdout(Stdio::null()).stderr(Stdio::null());
    ask.status().is_ok_and(|status| status.success())
}

fn command(python: &Path) -> Command {
    let mut command = Command::new(python);
    command.env("PYTHONSAFEPATH", "1");
    command
}
