"""The live view's server and scene."""
