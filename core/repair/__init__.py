"""In-betweens that never cross themselves: a method's path, bent as far as needed and no further."""
