"""The methods: each has fixed parameters and a rule for the next step."""
