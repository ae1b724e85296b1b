"""One bearing under one load, and comparisons of such."""
