"""The live view's simulation: no sockets, no drawing."""
