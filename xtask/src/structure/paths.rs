//! Which paths the files of a crate mention, by Rust's tokens: comments and strings say nothing here.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// A module, as the names from the root of its crate.
pub type Module = Vec<String>;

/// A path as it is written.
#[derive(Debug, PartialEq)]
pub struct Mention {
    /// The module that it stands in.
    pub within: Module,
    /// Its names.
    pub names: Vec<String>,
    /// The name that `use` gives it.
    pub known_as: Option<String>,
}

/// The paths in the text of a module, without those of its tests.
pub fn mentions(module: &Module, text: &str) -> Result<Vec<Mention>, String> {
    let tokens: TokenStream = text.parse().map_err(|error| format!("{error}"))?;
    let mut found = Vec::new();
    read(tokens, module, &mut found);
    Ok(found)
}

fn read(tokens: TokenStream, within: &Module, found: &mut Vec<Mention>) {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        let rest = &tokens[at..];
        at += match token {
            TokenTree::Punct(_) if is_for_tests(rest) => item(rest),
            TokenTree::Ident(word) if *word == "use" && !is(rest.get(1), '<') => {
                let length = item(rest);
                let tree = rest[1..length].split(|token| is(Some(token), ';')).next();
                imports(tree.unwrap_or_default(), &[], within, found);
                length
            }
            TokenTree::Ident(word) if *word == "mod" => inline_module(rest, within, found),
            TokenTree::Ident(_) => {
                let names = path(rest);
                let length = 3 * names.len() - 2;
                if names.len() > 1 {
                    found.push(Mention { within: within.clone(), names, known_as: None });
                }
                length
            }
            TokenTree::Group(group) => {
                read(group.stream(), within, found);
                1
            }
            _ => 1,
        };
    }
}

fn is(token: Option<&TokenTree>, mark: char) -> bool {
    matches!(token, Some(TokenTree::Punct(punct)) if punct.as_char() == mark)
}

/// Whether an item follows that is for tests alone.
fn is_for_tests(tokens: &[TokenTree]) -> bool {
    let Some(TokenTree::Group(attribute)) = tokens.get(1) else { return false };
    let mut words = attribute.stream().into_iter();
    let is_condition = words.next().is_some_and(|word| word.to_string() == "cfg");
    let condition = words.next().map(|group| group.to_string()).unwrap_or_default();
    let tests = condition == "(test)" || condition.replace(' ', "").starts_with("(all(test,");
    is(tokens.first(), '#') && is_condition && tests
}

/// The number of tokens up to the end of an item.
fn item(tokens: &[TokenTree]) -> usize {
    let is_end = |token: &TokenTree| match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        token => is(Some(token), ';'),
    };
    // the braces of `use a::{b, c};` are not its end
    let is_import = matches!(&tokens[0], TokenTree::Ident(word) if *word == "use");
    let end = tokens.iter().position(|token| match is_import {
        true => is(Some(token), ';'),
        false => is_end(token),
    });
    end.map_or(tokens.len(), |end| end + 1)
}

/// Reads a module that stands in its parent's file; returns the number of tokens read.
fn inline_module(tokens: &[TokenTree], within: &Module, found: &mut Vec<Mention>) -> usize {
    match tokens {
        [_, TokenTree::Ident(name), TokenTree::Group(body), ..] => {
            let module = [&within[..], &[name.to_string()]].concat();
            read(body.stream(), &module, found);
            3
        }
        _ => 1,
    }
}

/// The names at the beginning, joined by `::`.
fn path(tokens: &[TokenTree]) -> Vec<String> {
    let mut names = Vec::new();
    let mut rest = tokens;
    while let Some(TokenTree::Ident(name)) = rest.first() {
        names.push(name.to_string());
        if !(is(rest.get(1), ':') && is(rest.get(2), ':')) {
            break;
        }
        rest = &rest[3..];
        if !matches!(rest.first(), Some(TokenTree::Ident(_))) {
            break;
        }
    }
    names
}

/// The leaves of what follows `use`, behind the names of `before`.
fn imports(tree: &[TokenTree], before: &[String], within: &Module, found: &mut Vec<Mention>) {
    let trees = tree.split(|token| is(Some(token), ','));
    // behind a last comma there is nothing
    for tree in trees.filter(|tree| !tree.is_empty()) {
        let names = [before, &path(tree)].concat();
        let known_as = match tree {
            [.., TokenTree::Ident(word), TokenTree::Ident(name)] if *word == "as" => {
                Some(name.to_string())
            }
            _ => names.iter().rfind(|name| *name != "self").cloned(),
        };
        match tree.iter().find(|token| matches!(token, TokenTree::Group(_))) {
            Some(TokenTree::Group(group)) => {
                let inner: Vec<TokenTree> = group.stream().into_iter().collect();
                imports(&inner, &names, within, found);
            }
            _ => found.push(Mention { within: within.clone(), names, known_as }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<String> {
        let found = mentions(&vec!["a".into()], text).unwrap();
        let shown = |mention: Mention| {
            let path = mention.names.join("::");
            let name = mention.known_as.map(|name| format!(" as {name}"));
            format!("{}: {path}{}", mention.within.join("::"), name.unwrap_or_default())
        };
        found.into_iter().map(shown).collect()
    }

    #[test]
    fn the_leaves_of_use_are_told_with_the_names_they_get() {
        let found = read("pub(crate) use crate::{b::{self, C as D}, e::*,};\nuse super::F;");
        let wanted = [
            "a: crate::b::self as b",
            "a: crate::b::C as D",
            "a: crate::e as e",
            "a: super::F as F",
        ];
        assert_eq!(found, wanted);
    }

    #[test]
    fn paths_are_told_wherever_they_stand_and_comments_and_strings_say_nothing() {
        let text = "/// See [`crate::x`].\nfn f(c: &super::C) -> u8 { // crate::y\n\
                    print!(\"crate::z {}\", child::g::<Vec<u8>>(1)); b.d::<u8>()\n}";
        assert_eq!(read(text), ["a: super::C", "a: child::g"]);
    }

    #[test]
    fn tests_are_left_out_and_a_module_in_the_file_has_its_own_place() {
        let text = "mod b { use super::c; }\nmod d;\n#[cfg(test)]\nmod tests { use crate::e; }\n\
                    #[cfg(test)]\nuse crate::f::{g, h};\nuse crate::i;";
        assert_eq!(read(text), ["a::b: super::c as c", "a: crate::i as i"]);
    }
}
