"""The live view's server, and everything that it sends."""
