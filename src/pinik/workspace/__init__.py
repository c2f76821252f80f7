"""What a robot can reach: maps of its workspace, by sampling joint space and by solving for each cell."""
