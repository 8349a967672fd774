//! What the chores need to know of Markdown: blocks of code, prose, inline code, links, anchors.

use std::collections::BTreeMap;
use std::ops::Range;

use pulldown_cmark::{CodeBlockKind, CowStr, Event, Options, Parser, Tag, TagEnd};

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

/// What a document holds; lines are counted from 1.
#[derive(Debug, Default)]
pub struct Document {
    /// Lines outside of blocks of code.
    pub prose: Vec<(usize, String)>,
    /// Blocks of code in order.
    pub blocks: Vec<Block>,
    /// Inline code, with its line.
    pub code: Vec<(usize, String)>,
    /// Targets of links and pictures, with their lines.
    pub links: Vec<(usize, String)>,
    /// Anchors of the headings, as Git hosts and mdBook both make them.
    pub anchors: Vec<String>,
}

/// Cuts a document into its parts.
pub fn parse(text: &str) -> Document {
    let mut document = Document::default();
    let mut block: Option<Block> = None;
    let mut heading: Option<String> = None;
    let mut code_lines: Vec<Range<usize>> = Vec::new();
    // headings of the same words so far
    let mut alike: BTreeMap<String, usize> = BTreeMap::new();
    let line_of = |byte: usize| text[..byte].matches('\n').count() + 1;
    for (event, range) in Parser::new_ext(text, Options::ENABLE_TABLES).into_offset_iter() {
        let line = line_of(range.start);
        match event {
            Event::Start(Tag::CodeBlock(kind)) => {
                let end = line_of(range.start + text[range].trim_end().len());
                code_lines.push(line..end + 1);
                block = Some(opened(&kind, line));
            }
            Event::End(TagEnd::CodeBlock) => document.blocks.extend(block.take()),
            Event::Text(code) if block.is_some() => {
                block.iter_mut().for_each(|block| block.text.push_str(&code));
            }
            Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => {
                let slug = slug(&heading.take().unwrap_or_default());
                let before = alike.entry(slug.clone()).or_insert(0);
                let anchor = if *before == 0 { slug } else { format!("{slug}-{before}") };
                *before += 1;
                document.anchors.push(anchor);
            }
            Event::Text(words) => heading.iter_mut().for_each(|heading| heading.push_str(&words)),
            Event::Code(code) => {
                heading.iter_mut().for_each(|heading| heading.push_str(&code));
                document.code.push((line, code.to_string()));
            }
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                document.links.push((line, dest_url.to_string()));
            }
            Event::Html(html) | Event::InlineHtml(html) => {
                document.links.extend(sources(&html).map(|target| (line, target)));
            }
            _ => {}
        }
    }
    let is_code = |line: &usize| code_lines.iter().any(|lines| lines.contains(line));
    let prose = text.lines().enumerate().map(|(i, text)| (i + 1, text.to_owned()));
    document.prose = prose.filter(|(line, _)| !is_code(line)).collect();
    document
}

fn opened(kind: &CodeBlockKind<'_>, line: usize) -> Block {
    let (fenced, info) = match kind {
        CodeBlockKind::Fenced(info) => (true, info.clone()),
        CodeBlockKind::Indented => (false, CowStr::Borrowed("")),
    };
    let info = info.split_whitespace().map(str::to_owned).collect();
    Block { line: line + usize::from(fenced), info, fenced, text: String::new() }
}

/// What HTML refers to.
fn sources(html: &str) -> impl Iterator<Item = String> {
    let openings = ["src=\"", "href=\""].into_iter();
    let rests = openings.flat_map(move |opening| html.split(opening).skip(1));
    rests.filter_map(|rest| rest.split('"').next().map(str::to_owned))
}

/// Lower case; letters, digits, `_` and `-` stay, spaces become `-`, all else goes.
fn slug(heading: &str) -> String {
    let kept = heading.chars().filter_map(|c| match c {
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
        let text = "## Exact contact (`contact.enforcement = \"exact\"`)\n# A [b c](d.md)\n# A b c\n# A b c\n# B 1\n# B\n#no\n";
        let wanted =
            ["exact-contact-contactenforcement--exact", "a-b-c", "a-b-c-1", "a-b-c-2", "b-1", "b"];
        assert_eq!(parse(text).anchors, wanted);
    }

    #[test]
    fn inline_code_is_what_stands_between_two_backticks() {
        let document = parse("a `b c` d\n`e` f `g");
        assert_eq!(document.code, [(1, "b c".to_owned()), (2, "e".to_owned())]);
    }
}
