"""The tools on the left: one class a tool, one gesture from press to release."""
