//! What the chores need to know of Markdown: fenced and indented blocks, prose, headings.

/// A block of code of a document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// Line of its first line of code, from 1.
    pub line: usize,
    /// Words after the opening fence; none for an indented block.
    pub info: Vec<String>,
    /// Whether it stands between fences.
    pub fenced: bool,
    /// Its lines, joined, without the indent.
    pub text: String,
}

/// A document cut into prose and code.
#[derive(Debug, Default)]
pub struct Document {
    /// Lines of prose with their numbers, from 1.
    pub prose: Vec<(usize, String)>,
    /// Blocks of code in order.
    pub blocks: Vec<Block>,
}

/// Cuts a document into prose and blocks. Lists of the project's documents are not indented by four, so
/// that four spaces after an empty line always begin code.
pub fn parse(text: &str) -> Document {
    let mut document = Document::default();
    let mut open: Option<Block> = None;
    let mut after_empty = true;
    for (i, line) in text.lines().enumerate() {
        let trimmed = line.trim_start();
        if let Some(block) = &mut open {
            let closes = if block.fenced {
                trimmed.starts_with("```")
            } else {
                !trimmed.is_empty() && !line.starts_with("    ")
            };
            if !closes {
                block.text.push_str(if block.fenced {
                    line
                } else {
                    line.trim_start_matches("    ")
                });
                block.text.push('\n');
                continue;
            }
            let fenced = block.fenced;
            document.blocks.extend(open.take());
            if fenced {
                after_empty = true;
                continue;
            }
        }
        if let Some(info) = trimmed.strip_prefix("```") {
            let info = info.split_whitespace().map(str::to_owned).collect();
            open = Some(Block { line: i + 2, info, fenced: true, text: String::new() });
        } else if after_empty && line.starts_with("    ") && !trimmed.is_empty() {
            let text = format!("{}\n", line.trim_start_matches("    "));
            open = Some(Block { line: i + 1, info: Vec::new(), fenced: false, text });
        } else {
            document.prose.push((i + 1, line.to_owned()));
        }
        after_empty = trimmed.is_empty();
    }
    document.blocks.extend(open);
    document
}

/// Spans of inline code in a line of prose.
pub fn code_spans(line: &str) -> impl Iterator<Item = &str> {
    // Between backticks stands code: every second piece, if the last one is closed.
    let closed = line.matches('`').count() / 2;
    line.split('`').skip(1).step_by(2).take(closed)
}

/// A line of prose without its inline code.
pub fn without_code(line: &str) -> String {
    line.split('`').step_by(2).collect::<Vec<_>>().join("`")
}

/// Anchors of a document's headings, as Git hosts and mdBook both make them.
pub fn anchors(document: &Document) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for (_, line) in &document.prose {
        let level = line.bytes().take_while(|&byte| byte == b'#').count();
        if !(1..=6).contains(&level) || line.as_bytes().get(level) != Some(&b' ') {
            continue;
        }
        let slug = slug(&line[level..]);
        let before = found.iter().filter(|other| **other == slug).count();
        found.push(if before == 0 { slug } else { format!("{slug}-{before}") });
    }
    found
}

/// Lower case; letters, digits, `_` and `-` stay, spaces become `-`, all else goes.
fn slug(heading: &str) -> String {
    // of a link only the text shows
    let mut shown = String::new();
    let mut rest = heading.trim();
    while let Some((before, link)) = rest.split_once('[') {
        let Some((text, (_, after))) =
            link.split_once("](").and_then(|(text, link)| Some((text, link.split_once(')')?)))
        else {
            break;
        };
        shown.push_str(before);
        shown.push_str(text);
        rest = after;
    }
    shown.push_str(rest);
    let kept = shown.chars().filter_map(|c| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || c == '-' || c == '_' => Some(c),
        _ => None,
    });
    kept.collect::<String>().to_lowercase()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fences_and_indents_are_code_and_the_rest_is_prose() {
        let text = "# A\n\n    indented\n\n    more\nprose\n    still prose\n```sh run exit=1\nfalse\n```\nend\n";
        let document = parse(text);
        let blocks: Vec<_> = document.blocks.iter().map(|b| (b.line, b.text.as_str())).collect();
        assert_eq!(blocks, [(3, "indented\n\nmore\n"), (9, "false\n")]);
        assert_eq!(document.blocks[1].info, ["sh", "run", "exit=1"]);
        let prose: Vec<_> = document.prose.iter().map(|(n, l)| (*n, l.as_str())).collect();
        assert_eq!(prose, [(1, "# A"), (2, ""), (6, "prose"), (7, "    still prose"), (11, "end")]);
    }

    #[test]
    fn anchors_are_those_of_git_hosts() {
        let text =
            "## Exact contact (`contact.enforcement = \"exact\"`)\n# A [b c](d.md)\n# A b c\n#no\n";
        let wanted = ["exact-contact-contactenforcement--exact", "a-b-c", "a-b-c-1"];
        assert_eq!(anchors(&parse(text)), wanted);
    }

    #[test]
    fn inline_code_is_what_stands_between_two_backticks() {
        let line = "a `b c` d `e` f `g";
        assert_eq!(code_spans(line).collect::<Vec<_>>(), ["b c", "e"]);
    }
}
