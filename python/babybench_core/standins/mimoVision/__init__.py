"""MIMo's vision."""
