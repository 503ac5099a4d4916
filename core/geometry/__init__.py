"""Pure functions on (n, 2) arrays of points; they know no drawing, span or document."""
