"""The canvas: one item a thing, drawn from one description of what is to be seen."""
