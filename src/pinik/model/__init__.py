"""A Pinocchio model with names: joints, limits, poses, chains."""
