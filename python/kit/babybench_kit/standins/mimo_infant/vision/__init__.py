"""MIMo 3's vision."""
