"""The messages that the page and the server exchange."""
