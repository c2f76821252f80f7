"""The methods: frozen parameters and one rule for the next step."""
