"""A robot file, from text to a checked tree."""
