"""Files for other programs: numbered frames as PNG."""
