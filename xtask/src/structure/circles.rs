//! No circle of modules has more than two files.
//!
//! A file uses the file that defines what it uses, also where another one hands it on by `use`. A module and
//! its children may use one another, each by itself; a circle of three files is one idea in three places, or
//! three ideas that cannot be read one after the other.

use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::fs;
use std::path::Path;

use super::paths::{Mention, Module, mentions};

/// By file, those that it uses.
type Uses = BTreeMap<Module, BTreeSet<Module>>;

/// The circles of three files or more in the crates of the checkout at `root`, one line each.
pub fn circles(root: &Path) -> Result<Vec<String>, String> {
    let folders = fs::read_dir(root.join("crates")).map_err(|error| format!("crates: {error}"))?;
    let mut folders: Vec<_> = folders.flatten().map(|folder| folder.path()).collect();
    folders.push(root.join("xtask"));
    folders.sort();
    let mut told = Vec::new();
    for folder in folders {
        let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let mut texts = BTreeMap::new();
        add(&folder.join("src"), &Module::new(), &mut texts)
            .map_err(|error| format!("{}: {error}", folder.display()))?;
        let uses = uses(&texts).map_err(|error| format!("the crate {name}: {error}"))?;
        told.extend(apart(&uses).iter().map(|circle| line(&name, circle)));
    }
    Ok(told)
}

fn line(name: &str, circle: &[Module]) -> String {
    let shown = |module: &Module| match module.is_empty() {
        true => "the root".to_owned(),
        false => module.join("::"),
    };
    let files: Vec<String> = circle.iter().chain(circle.first()).map(shown).collect();
    let number = circle.len();
    format!(
        "in the crate {name}, {number} files use one another in a circle: {}",
        files.join(" > ")
    )
}

/// Adds the texts of the files below a folder by their modules, without tests and further programs.
fn add(
    folder: &Path,
    module: &Module,
    texts: &mut BTreeMap<Module, String>,
) -> std::io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let mut inner = module.clone();
        let has_library = module.is_empty() && folder.join("lib.rs").exists();
        let is_root = module.is_empty() && ["lib", "main"].contains(&name.as_str());
        let is_program = module.is_empty() && name == "bin" || has_library && name == "main";
        if name == "tests" || is_program {
            continue;
        }
        if !is_root && name != "mod" {
            inner.push(name);
        }
        if path.is_dir() {
            add(&path, &inner, texts)?;
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            texts.insert(inner, fs::read_to_string(&path)?);
        }
    }
    Ok(())
}

/// Which file of a crate uses which.
fn uses(texts: &BTreeMap<Module, String>) -> Result<Uses, String> {
    let mut found = Vec::new();
    for (module, text) in texts {
        let at = |error| format!("{}: {error}", module.join("::"));
        found.push((module, mentions(module, text).map_err(at)?));
    }
    let names = Names::of(texts, found.iter().flat_map(|(_, mentions)| mentions));
    let used = |(module, mentions): (&Module, Vec<Mention>)| {
        let files = mentions.iter().filter_map(|mention| names.file(mention));
        (module.clone(), files.filter(|file| file != module).collect())
    };
    Ok(found.into_iter().map(used).collect())
}

/// What the names of a crate stand for.
struct Names<'a> {
    files: &'a BTreeMap<Module, String>,
    /// What `use` makes of a name in a module: a path from the root of the crate.
    imported: BTreeMap<Module, Module>,
}

impl<'a> Names<'a> {
    fn of<'b>(
        files: &'a BTreeMap<Module, String>,
        mentions: impl Iterator<Item = &'b Mention>,
    ) -> Self {
        let mut names = Self { files, imported: BTreeMap::new() };
        let mut imported = BTreeMap::new();
        for mention in mentions {
            let (Some(name), Some(path)) = (&mention.known_as, names.rooted(mention)) else {
                continue;
            };
            let here = [&mention.within[..], std::slice::from_ref(name)].concat();
            if here != path {
                imported.insert(here, path);
            }
        }
        names.imported = imported;
        names
    }

    /// The path of a mention from the root of the crate; none for what other crates have.
    fn rooted(&self, mention: &Mention) -> Option<Module> {
        let Mention { within, names, .. } = mention;
        let ups = names.iter().take_while(|name| *name == "super").count();
        let (base, rest) = match names.first()?.as_str() {
            "crate" => (&within[..0], &names[1..]),
            "self" => (&within[..], &names[1..]),
            "super" => (&within[..within.len().checked_sub(ups)?], &names[ups..]),
            first => {
                let here = [&within[..], &[first.to_owned()]].concat();
                if !self.files.contains_key(&here) && !self.imported.contains_key(&here) {
                    return None;
                }
                (&within[..], &names[..])
            }
        };
        let rest = rest.iter().filter(|name| *name != "self");
        Some(base.iter().chain(rest).cloned().collect())
    }

    /// The file that defines what a mention means.
    fn file(&self, mention: &Mention) -> Option<Module> {
        let mut path = self.rooted(mention)?;
        // as often as one file may hand a name on to the next; names that go round have no definition
        for _ in 0..8 {
            let file = (0..=path.len()).rev().find(|&n| self.files.contains_key(&path[..n]))?;
            let imported =
                (file + 1..=path.len()).find_map(|n| Some((n, self.imported.get(&path[..n])?)));
            match imported {
                Some((n, other)) => path = [other, &path[n..]].concat(),
                None => return Some(path[..file].to_vec()),
            }
        }
        None
    }
}

/// Circles of three files or more, the shortest ones, none of which shares a file with another.
fn apart(uses: &Uses) -> Vec<Vec<Module>> {
    let pairs = uses.iter().flat_map(|(file, used)| used.iter().map(move |used| (file, used)));
    let mut circles: Vec<_> = pairs.filter_map(|(file, used)| circle(uses, file, used)).collect();
    circles.sort_by_key(Vec::len);
    let mut told = BTreeSet::new();
    circles.retain(|circle| {
        let is_new = !circle.iter().any(|file| told.contains(file));
        if is_new {
            told.extend(circle.iter().cloned());
        }
        is_new
    });
    circles
}

/// The shortest circle that goes from `first` to `second` and not straight back.
fn circle(uses: &Uses, first: &Module, second: &Module) -> Option<Vec<Module>> {
    let mut before = BTreeMap::from([(second, first)]);
    let mut open = VecDeque::from([second]);
    while let Some(file) = open.pop_front() {
        for used in uses.get(file).into_iter().flatten() {
            if used == first && file != second {
                let way = std::iter::successors(Some(file), |file| before.get(file).copied());
                let mut circle: Vec<Module> =
                    way.take_while(|file| *file != first).cloned().collect();
                circle.push(first.clone());
                circle.reverse();
                return Some(circle);
            }
            if used != first && !before.contains_key(used) {
                before.insert(used, file);
                open.push_back(used);
            }
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(files: &[(&str, &str)]) -> Vec<String> {
        let module =
            |name: &str| name.split("::").filter(|n| !n.is_empty()).map(Into::into).collect();
        let texts = files.iter().map(|(name, text)| (module(name), (*text).to_owned())).collect();
        apart(&uses(&texts).unwrap()).iter().map(|circle| line("x", circle)).collect()
    }

    #[test]
    fn a_circle_of_three_files_is_told_in_its_order() {
        let told = found(&[
            ("", "mod a; mod b; mod c; use a::A;"),
            ("a", "use crate::b::B; pub struct A;"),
            ("b", "pub fn b() { super::c::c() }"),
            ("c", "use super::a; pub fn c() { a::A }"),
        ]);
        let wanted = "in the crate x, 3 files use one another in a circle: a > b > c > a";
        assert_eq!(told, [wanted]);
    }

    #[test]
    fn a_file_and_its_children_may_use_one_another_each_by_itself() {
        let parent = ("a", "mod b; mod c; pub fn f() { b::g(); c::h() }");
        let child = ("a::b", "use super::f;");
        let star = [parent, child, ("a::c", "use super::f;")];
        assert_eq!(found(&star), Vec::<String>::new());
        let closed = [parent, child, ("a::c", "use super::{b::g, f};")];
        let wanted = "in the crate x, 3 files use one another in a circle: a > a::c > a::b > a";
        assert_eq!(found(&closed), [wanted]);
    }

    #[test]
    fn what_is_handed_on_counts_where_it_is_defined() {
        let handed_on = [
            ("", "mod a; mod b; pub use a::A; pub use b::{B as C};"),
            ("a", "pub struct A;"),
            ("b", "use crate::A; pub struct B;"),
        ];
        assert_eq!(found(&handed_on), Vec::<String>::new());
        let defined = [
            ("", "mod a; mod b; use a::A; pub struct C;"),
            ("a", "use crate::b::B; pub struct A;"),
            ("b", "use crate::C; pub struct B;"),
        ];
        let wanted =
            "in the crate x, 3 files use one another in a circle: the root > a > b > the root";
        assert_eq!(found(&defined), [wanted]);
    }
}
