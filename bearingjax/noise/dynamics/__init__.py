"""Rolling elements, cage and rings as masses that move in time."""
