//! Results in, SVG and HTML text out.
