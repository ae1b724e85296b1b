"""Plots of rolling elements that skid."""
