"""Pictures of robots without a browser."""
