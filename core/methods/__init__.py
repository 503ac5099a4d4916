"""How vertices travel from one keyframe to the next."""
