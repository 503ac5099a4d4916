"""The panels around the canvas; none of them knows another."""
