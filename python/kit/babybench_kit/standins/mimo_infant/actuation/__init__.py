"""MIMo 3's actuation."""
