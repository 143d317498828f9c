//! Model text to checked values.
