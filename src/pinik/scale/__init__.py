"""Work by the million: files of poses in, files of answers out, in jobs that can be killed, resumed and distributed."""
