"""MIMo 3's growth."""
