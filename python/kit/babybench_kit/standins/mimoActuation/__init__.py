"""MIMo's actuation models."""
