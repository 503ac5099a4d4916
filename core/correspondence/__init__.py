"""Which point of one outline goes where on another."""
