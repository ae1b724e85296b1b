"""One roller on a raceway."""
