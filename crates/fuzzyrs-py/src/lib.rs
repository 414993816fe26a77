//! The Python face of fuzzyrs.
