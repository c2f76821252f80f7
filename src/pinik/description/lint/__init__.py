"""What is plainly wrong, or hardly meant, in a robot description that can be read all the same."""
