"""What goes to the terminal, and how."""
