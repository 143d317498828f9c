//! Prints the table of notices of the book: `cargo xtask notices`.

fn main() {
    print!("{}", slipstick::notice::table());
}
