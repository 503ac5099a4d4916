"""Slow work beside the window: the newest request wins."""
