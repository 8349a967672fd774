//! A command line cut into commands and words, as far as the documents need it.

/// Commands of a script: words without quotes, one command for each part of a pipe or list. Comments,
/// redirections to and from files, here-documents and assignments before a command are left out.
pub fn commands(script: &str) -> Vec<Vec<String>> {
    let mut commands = Vec::new();
    let joined = script.replace("\\\n", " ");
    let mut lines = joined.lines();
    while let Some(line) = lines.next() {
        let words = words(line);
        if let Some(end) = words.iter().find_map(|word| word.strip_prefix("<<")) {
            for _ in lines.by_ref().take_while(|line| line.trim() != end) {}
        }
        let mut command: Vec<String> = Vec::new();
        let mut redirected = false;
        for word in words {
            match word.as_str() {
                "|" | "||" | "&&" | ";" | "&" => commands.push(std::mem::take(&mut command)),
                ">" | ">>" | "<" | "2>" => redirected = true,
                _ if std::mem::take(&mut redirected) || word.starts_with("<<") => {}
                _ if command.is_empty() && is_assignment(&word) => {}
                _ => command.push(word),
            }
        }
        commands.push(command);
    }
    commands.retain(|command| !command.is_empty());
    commands
}

fn is_assignment(word: &str) -> bool {
    word.split_once('=').is_some_and(|(name, _)| {
        !name.is_empty() && name.chars().all(|c| c.is_ascii_uppercase() || c == '_')
    })
}

/// Words of a line, quotes taken off.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut word: Option<String> = None;
    let mut quote = None;
    for c in line.chars() {
        match (quote, c) {
            (Some(open), c) if c == open => quote = None,
            (Some(_), c) => word.get_or_insert_default().push(c),
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, '#') if word.is_none() => break,
            (None, ';') => {
                words.extend(word.take());
                words.push(";".into());
            }
            (None, c) if c.is_whitespace() => words.extend(word.take()),
            (None, c) => word.get_or_insert_default().push(c),
        }
    }
    words.extend(word);
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_keep_what_quotes_hold_and_lose_comments() {
        let script = "creepage run a.toml --set contact.enforcement='\"exact\"' \\\n  --out \"b c\"  # why\n";
        let wanted =
            ["creepage", "run", "a.toml", "--set", "contact.enforcement=\"exact\"", "--out"];
        assert_eq!(commands(script), [[&wanted[..], &["b c"]].concat()]);
    }

    #[test]
    fn pipes_lists_and_redirections_part_commands() {
        let script = "cd a && A=1 b --x > c.json | d; e\ncat > f <<'END'\nnot a command\nEND\ng\n";
        let wanted: [&[&str]; 6] = [&["cd", "a"], &["b", "--x"], &["d"], &["e"], &["cat"], &["g"]];
        assert_eq!(commands(script), wanted);
    }
}
