"""The compiled programs that are kept: their size and place, and those to come."""
