"""The live view's simulation: no socket, no drawing."""
