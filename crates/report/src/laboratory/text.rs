//! Aligned columns of plain text.

use slipstick::error::visible;

/// Whether a cell of a table is a number, or stands for one.
pub fn is_number(cell: &str) -> bool {
    cell.is_empty()
        || cell == "—"
        || cell.starts_with(['<', '−', '-', '+'])
        || cell.starts_with(|c: char| c.is_ascii_digit())
}

/// Lines of cells, each column as wide as its widest; names and columns of words left, numbers right.
pub fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    // What governs has a star behind its number, in a place of its own.
    let bare = |cell: &String| cell.strip_suffix('*').unwrap_or(cell).to_owned();
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        let starred = cells.clone().any(|cell| cell.ends_with('*'));
        (cells.map(|cell| bare(cell).chars().count()).max().unwrap_or(0), starred)
    };
    let widths: Vec<(usize, bool)> = (0..columns).map(width).collect();
    let of_words = |column: usize| {
        let cells = rows.iter().skip(1).filter_map(|row| row.get(column));
        let (numbers, words): (Vec<_>, Vec<_>) = cells.partition(|cell| is_number(cell));
        column == 0 || words.len() > numbers.len()
    };
    let words: Vec<bool> = (0..columns).map(of_words).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, cell) in row.iter().enumerate() {
            let (width, starred) = widths[column];
            if column == 0 {
                line.push_str(&format!("{cell:<width$}"));
            } else if words[column] {
                line.push_str(&format!("  {cell:<width$}"));
            } else {
                let star = match cell.ends_with('*') {
                    true => "*",
                    false if starred => " ",
                    false => "",
                };
                line.push_str(&format!("  {:>width$}{star}", bare(cell)));
            }
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    clean(&text)
}

/// The same rows, those with cells of many words as several under each other.
pub fn wrapped(rows: &[Vec<String>]) -> Vec<Vec<String>> {
    const MOST: usize = 50;
    let lines = |cell: &String| {
        let indent = " ".repeat(cell.chars().take_while(|c| *c == ' ').count());
        let mut lines = vec![indent.clone()];
        for word in cell.split_whitespace() {
            let line = lines.last().map_or(0, |line| line.chars().count());
            match lines.last_mut() {
                Some(last) if line == indent.len() => last.push_str(word),
                Some(last) if line + 1 + word.chars().count() <= MOST => {
                    last.push(' ');
                    last.push_str(word);
                }
                _ => lines.push(format!("{indent}  {word}")),
            }
        }
        lines
    };
    let split = |row: &Vec<String>| {
        if row.iter().all(|cell| cell.chars().count() <= MOST) {
            return vec![row.clone()];
        }
        let cells: Vec<Vec<String>> = row.iter().map(lines).collect();
        let most = cells.iter().map(Vec::len).max().unwrap_or(0);
        let line =
            |i: usize| cells.iter().map(move |cell| cell.get(i).cloned().unwrap_or_default());
        (0..most).map(|i| line(i).collect()).collect()
    };
    rows.iter().flat_map(split).collect()
}

/// Lines of cells, each column as wide as its widest; those that `is_left` names left, the others right.
pub fn padded(rows: &[Vec<String>], is_left: impl Fn(usize) -> bool) -> String {
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|c| c.chars().count()).max().unwrap_or(0)
    };
    let line = |row: &Vec<String>| {
        let cells = row.iter().enumerate().map(|(i, cell)| {
            let space = " ".repeat(width(i) - cell.chars().count());
            if is_left(i) { format!("{cell}{space}") } else { format!("{space}{cell}") }
        });
        format!("{}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

/// A table of many columns as several, each with the first column and at most `most` others.
pub fn in_groups(rows: &[Vec<String>], most: usize) -> Vec<Vec<Vec<String>>> {
    let columns = rows.first().map_or(0, |row| row.len().saturating_sub(1));
    let groups = columns.div_ceil(most.max(1)).max(1);
    let size = columns.div_ceil(groups);
    let part = |row: &Vec<String>, group: usize| -> Vec<String> {
        row.iter().take(1).chain(row.iter().skip(1 + group * size).take(size)).cloned().collect()
    };
    (0..groups).map(|group| rows.iter().map(|row| part(row, group)).collect()).collect()
}

/// A name and a sentence beside it, wrapped at blanks.
pub fn field(name: &str, sentence: &str) -> String {
    const INDENT: usize = 9;
    const WIDTH: usize = 96;
    let mut text = String::new();
    let mut line = format!("{name:<INDENT$}");
    let mut empty = true;
    for word in sentence.split_whitespace() {
        if !empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
            text.push_str(line.trim_end());
            text.push('\n');
            line = " ".repeat(INDENT);
            empty = true;
        }
        if !empty {
            line.push(' ');
        }
        line.push_str(word);
        empty = false;
    }
    text.push_str(line.trim_end());
    text.push('\n');
    clean(&text)
}

/// Names come from users: a control character must not reach a terminal.
fn clean(text: &str) -> String {
    text.split('\n').map(visible).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_repeat_the_names() {
        let row = |text: &str| text.split(' ').map(str::to_owned).collect::<Vec<String>>();
        let groups = in_groups(&[row("n a b c d"), row("m 1 2 3 4")], 3);
        assert_eq!(groups[0], [row("n a b"), row("m 1 2")]);
        assert_eq!(groups[1], [row("n c d"), row("m 3 4")]);
        assert_eq!(in_groups(&[], 3), vec![Vec::<Vec<String>>::new()]);
    }

    #[test]
    fn cells_of_many_words_go_on_below() {
        let words = "one two three four five six seven eight nine ten eleven twelve".to_owned();
        let rows = wrapped(&[vec![format!("  {words}"), "1".to_owned()]]);
        let first = "  one two three four five six seven eight nine ten";
        let expected = [[first, "1"], ["    eleven twelve", ""]];
        assert_eq!(rows, expected.map(|row| row.map(str::to_owned).to_vec()));
        let short = vec![vec!["  a b".to_owned()]];
        assert_eq!(wrapped(&short), short);
    }

    #[test]
    fn columns_and_sentences() {
        let rows = [vec!["a".to_owned(), "10".to_owned()], vec!["bcd".to_owned(), "1".to_owned()]];
        assert_eq!(aligned(&rows), "a    10\nbcd   1\n");
        assert_eq!(field("Name", "a b"), "Name     a b\n");
    }
}
