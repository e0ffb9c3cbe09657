"""MIMo 3's touch."""
