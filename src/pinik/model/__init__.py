"""Pinocchio's model with names: joints, limits, poses, chains."""
