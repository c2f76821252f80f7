"""A robot's meshes, its collisions, and a second opinion on where they are."""
