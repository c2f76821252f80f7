"""A robot's meshes, and a second opinion on where they are."""
