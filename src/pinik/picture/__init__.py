"""Pictures of robots, drawn without a browser."""
