"""Systems of shafts."""
