"""Balls and rollers that skid."""
