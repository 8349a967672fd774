//! What the control groups of Linux (cgroups, version 1 and 2) leave to this process: the limits of containers
//! (`docker -m`, Kubernetes) and of batch systems (Slurm's `--mem`). A process that takes more is killed.

use std::path::{Path, PathBuf};
use std::str::FromStr;

use output::files::input;

/// The files of a version of control groups.
struct Version {
    /// Type of its file system.
    file_system: &'static str,
    /// The most memory (bytes); a word where there is no limit.
    limit: &'static str,
    /// Memory in use (bytes), the cache of files included.
    usage: &'static str,
    /// The entry of `memory.stat` for the cache that is given back when memory is short (bytes).
    cache: &'static str,
}

const VERSIONS: [Version; 2] = [
    Version {
        file_system: "cgroup",
        limit: "memory.limit_in_bytes",
        usage: "memory.usage_in_bytes",
        cache: "total_inactive_file",
    },
    Version {
        file_system: "cgroup2",
        limit: "memory.max",
        usage: "memory.current",
        cache: "inactive_file",
    },
];

/// Memory that the limits of the groups of this process leave to it (MB), infinite without a limit. `root` is the root
/// of the file system.
pub fn free_mb(root: &Path) -> f64 {
    let mounts = text(&root.join("proc/self/mountinfo"));
    let groups = text(&root.join("proc/self/cgroup"));
    let left = VERSIONS.iter().filter_map(|version| {
        let (top, group) = version.group(&mounts, &groups)?;
        // each group also keeps the limits of those above it
        let within = group.ancestors().take_while(|group| group.starts_with(&top));
        within.filter_map(|group| version.left(&under(root, group))).reduce(f64::min)
    });
    left.fold(f64::INFINITY, f64::min) / 1e6
}

impl Version {
    /// The folder of the topmost group that is seen here, and that of the group of this process.
    fn group(&self, mounts: &str, groups: &str) -> Option<(PathBuf, PathBuf)> {
        let first = self.file_system == "cgroup";
        let (inside, top) = mounts.lines().find_map(|line| {
            // number, parent, device, root inside the file system, mount point, options, - type, source, options
            let (place, kind) = line.split_once(" - ")?;
            let mut kind = kind.split(' ');
            let ours = kind.next() == Some(self.file_system)
                && (!first || kind.nth(1)?.split(',').any(|option| option == "memory"));
            let mut place = place.split(' ').skip(3);
            ours.then(|| Some((place.next()?, place.next()?)))?
        })?;
        let group = groups.lines().find_map(|line| {
            // number, controllers, path
            let mut fields = line.splitn(3, ':').skip(1);
            let controllers = fields.next()?;
            let ours = if first {
                controllers.split(',').any(|controller| controller == "memory")
            } else {
                controllers.is_empty()
            };
            ours.then(|| fields.next())?
        })?;
        // a container sees its own group as the top, by whatever path the system calls it
        let below = Path::new(group).strip_prefix(inside).unwrap_or(Path::new(""));
        let top = PathBuf::from(top);
        let group = top.join(below);
        Some((top, group))
    }

    /// What the limit of the group in `folder` leaves (bytes), where it has one.
    fn left(&self, folder: &Path) -> Option<f64> {
        let limit: f64 = number(&text(&folder.join(self.limit)))?;
        let usage: f64 = number(&text(&folder.join(self.usage)))?;
        let stat = text(&folder.join("memory.stat"));
        let entries = stat.lines().filter_map(|line| line.split_once(' '));
        let cache = entries.filter(|(name, _)| *name == self.cache).find_map(|(_, n)| number(n));
        Some((limit - usage + cache.unwrap_or(0.0)).clamp(0.0, limit))
    }
}

/// `path`, which is absolute, below `root`.
fn under(root: &Path, path: &Path) -> PathBuf {
    root.join(path.strip_prefix("/").unwrap_or(path))
}

/// The text of a file; empty where there is none.
fn text(path: &Path) -> String {
    input::text(path, input::LOG).unwrap_or_default()
}

fn number<T: FromStr>(text: &str) -> Option<T> {
    text.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use std::fs;

    use super::*;

    /// Free memory (MB) on a system with these files.
    fn free(files: &[(&str, &str)]) -> f64 {
        let root = tempfile::tempdir().unwrap();
        for (path, text) in files {
            let path = root.path().join(path);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        free_mb(root.path())
    }

    const FIRST: (&str, &str) = (
        "proc/self/mountinfo",
        "30 20 0:26 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu\n\
         31 20 0:27 / /sys/fs/cgroup/memory rw,relatime shared:9 - cgroup cgroup rw,memory\n\
         32 20 0:28 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw\n",
    );
    const SECOND: (&str, &str) =
        ("proc/self/mountinfo", "29 22 0:25 / /sys/fs/cgroup rw,nosuid - cgroup2 cgroup2 rw\n");

    #[test]
    fn a_group_of_version_1_leaves_its_limit_less_what_is_in_use_and_not_cache() {
        let found = free(&[
            FIRST,
            ("proc/self/cgroup", "5:memory:/job/7\n4:cpu:/\n0::/\n"),
            ("sys/fs/cgroup/memory/job/7/memory.limit_in_bytes", "60000000\n"),
            ("sys/fs/cgroup/memory/job/7/memory.usage_in_bytes", "25000000\n"),
            ("sys/fs/cgroup/memory/job/7/memory.stat", "cache 9\ntotal_inactive_file 5000000\n"),
            // no limit, as version 1 writes it
            ("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "9223372036854771712\n"),
            ("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "25000000\n"),
        ]);
        assert_eq!(found, 40.0);
    }

    #[test]
    fn a_group_of_version_2_keeps_the_limits_of_the_groups_above_it() {
        let files = [
            SECOND,
            ("proc/self/cgroup", "0::/slurm/job/step\n"),
            ("sys/fs/cgroup/slurm/job/step/memory.max", "max\n"),
            ("sys/fs/cgroup/slurm/job/step/memory.current", "1000000\n"),
            ("sys/fs/cgroup/slurm/job/memory.max", "80000000\n"),
            ("sys/fs/cgroup/slurm/job/memory.current", "30000000\n"),
            ("sys/fs/cgroup/slurm/job/memory.stat", "anon 1\ninactive_file 10000000\n"),
            ("sys/fs/cgroup/slurm/memory.max", "70000000\n"),
            ("sys/fs/cgroup/slurm/memory.current", "30000000\n"),
        ];
        assert_eq!(free(&files), 40.0);
        // without the limit of the topmost
        assert_eq!(free(&files[..7]), 60.0);
    }

    #[test]
    fn a_container_finds_its_group_at_the_top_of_what_it_sees() {
        let limit = ("sys/fs/cgroup/memory.max", "64000000\n");
        let usage = ("sys/fs/cgroup/memory.current", "4000000\n");
        // with a name space of its own
        assert_eq!(free(&[SECOND, ("proc/self/cgroup", "0::/\n"), limit, usage]), 60.0);
        // its processes were moved below another group
        assert_eq!(free(&[SECOND, ("proc/self/cgroup", "0::/../x\n"), limit, usage]), 60.0);
        // without one, the paths are those of the machine
        let mounts = "31 20 0:27 /docker/a1 /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n";
        let found = free(&[
            ("proc/self/mountinfo", mounts),
            ("proc/self/cgroup", "5:memory:/docker/a1\n"),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "64000000\n"),
            ("sys/fs/cgroup/memory/memory.usage_in_bytes", "4000000\n"),
        ]);
        assert_eq!(found, 60.0);
    }

    #[test]
    fn without_groups_or_a_limit_all_memory_is_free() {
        assert_eq!(free(&[]), f64::INFINITY);
        assert_eq!(free(&[SECOND, ("proc/self/cgroup", "0::/\n")]), f64::INFINITY);
        // more in use than a limit that was lowered
        let found = free(&[
            SECOND,
            ("proc/self/cgroup", "0::/\n"),
            ("sys/fs/cgroup/memory.max", "1000000\n"),
            ("sys/fs/cgroup/memory.current", "2000000\n"),
        ]);
        assert_eq!(found, 0.0);
    }
}
